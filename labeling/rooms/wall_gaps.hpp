#pragma once

#include <vector>

#include "labeling/rooms/level_surfaces.hpp"
#include "labeling/rooms/wall_faces.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

struct WallGapParams {
  double min_lintel = 1.7;       ///< m above the floor
  double lintel_gap = 0.10;      ///< m below the ceiling: what is nearer is the ceiling itself
  double max_gap = 2.40;         ///< m, of a gap that a lintel spans
  double max_unseen_gap = 1.40;  ///< m, of a gap above which nothing was seen at all
  double min_seen = 0.5;         ///< share of a gap that shows a lintel
};

/// Cells where the underside of a lintel was seen: something level between head and ceiling.
CellMask lintel_cells(const Cloud& plan, const FloorGrid& grid, const LevelSurface& floor,
                      const LevelSurface& ceiling, const WallGapParams& params = {});

/// Closes gaps between faces on one plane, and gaps at the end of a face as far as rays went
/// through, where a lintel spans them, or where they are as narrow as a door and nothing was seen
/// above. A wall above a door parts rooms even if no scan saw its face.
std::vector<WallFace> with_door_gaps_closed(std::vector<WallFace> faces, const FloorGrid& grid,
                                            const LevelSurface& ceiling, const CellMask& lintels,
                                            const CellMask& free, const WallGapParams& params = {});

}  // namespace planum
