#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/plan/floor_grid.hpp"
#include "labeling/rooms/level_surfaces.hpp"
#include "labeling/rooms/wall_faces.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

struct WallPointParams {
  double max_tilt = 0.35;    ///< rad of a wall point's normal out of the horizontal
  double band = 0.30;        ///< m below the ceiling where walls are looked for first
  double band_gap = 0.05;    ///< m directly below the ceiling that is left out
  double min_height = 0.30;  ///< m above the floor, of points lower down
  double min_top = 1.85;     ///< m above the floor that most of a wall reaches, or ...
  double min_end_top = 1.5;  ///< m, ... its highest part, if no ray passed behind it
  double min_length = 0.5;   ///< m, of the latter
  double min_piece = 0.2;    ///< m, of the former: the wall beside a door
};

/// Points on upright surfaces just below the ceiling in front of them. `plan` is a cloud with
/// normals in the plan frame.
std::vector<WallPoint> points_below_ceiling(const Cloud& plan, const FloorGrid& grid,
                                            const LevelSurface& ceiling,
                                            const WallPointParams& params = {});

/// Points on upright surfaces at all heights where no ceiling was seen behind them and no face is
/// known yet: walls whose upper part no scan saw, and furniture before them.
std::vector<WallPoint> points_lower_down(const Cloud& plan, const FloorGrid& grid,
                                         const LevelSurface& floor, const LevelSurface& ceiling,
                                         const std::vector<WallFace>& known,
                                         const WallPointParams& params = {});

/// Whether a face lower down is a wall: as long and as high as one, or with nothing free behind.
bool is_wall(const WallFace& face, const std::vector<WallPoint>& points, const FloorGrid& grid,
             const LevelSurface& floor, const CellMask& free, const WallPointParams& params = {});

}  // namespace planum
