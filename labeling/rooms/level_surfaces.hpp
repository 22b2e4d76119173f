#pragma once

#include <vector>

#include "labeling/plan/floor_grid.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// Which horizontal surface of a column is wanted.
enum class LevelSide { floor, ceiling };

struct LevelSurfaceParams {
  double max_tilt = 0.55;        ///< rad between a point's normal and the vertical
  double max_step = 0.06;        ///< m, cells that differ more in height belong to two patches
  double min_half_width = 0.35;  ///< m, a patch holds a disc of this radius: no lintel, no beam
  double fill_radius = 0.10;     ///< m, narrower gaps in a patch are filled
};

/// Large horizontal (or gently sloped) patches seen from above (floor) or from below (ceiling).
struct LevelSurface {
  std::vector<float> height;   ///< m for each cell; nan where no patch was seen
  std::vector<float> nearest;  ///< m, height of the nearest patch within some metres, else nan
};

/// The lowest upward (floor) or the highest downward surface (ceiling) of each cell, as far as they
/// form patches as wide as a person: the undersides of lintels and shelves are no ceilings.
/// `plan` is a cloud with normals in the plan frame of the grid. A ceiling cell must be
/// `min_clearance` above `floor.nearest` where `floor` is given.
LevelSurface find_level_surface(const Cloud& plan, const FloorGrid& grid, LevelSide side,
                                const LevelSurface* floor = nullptr, double min_clearance = 1.6,
                                const LevelSurfaceParams& params = {});

}  // namespace planum
