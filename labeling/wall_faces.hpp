#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "labeling/floor_grid.hpp"
#include "labeling/level_surfaces.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// One side of a wall seen from above: a segment of the line normal . x == offset in the plan
/// frame, from `begin` to `end` along the tangent.
struct WallFace {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit, into the room
  double offset = 0;                                  ///< m
  double begin = 0, end = 0;                          ///< m along tangent()

  /// A quarter turn to the left of the normal.
  Eigen::Vector2d tangent() const { return {-normal.y(), normal.x()}; }
  double length() const { return end - begin; }
  Eigen::Vector2d at(double along) const { return offset * normal + along * tangent(); }
  double signed_distance(const Eigen::Vector2d& p) const { return normal.dot(p) - offset; }
};

struct WallFaceParams {
  double band = 0.30;         ///< m below the ceiling where walls are looked for
  double band_gap = 0.05;     ///< m directly below the ceiling that is left out
  double max_tilt = 0.35;     ///< rad of a wall point's normal out of the horizontal
  double thickness = 0.05;    ///< m, points this near a line belong to it
  double max_turn = 0.40;     ///< rad between a point's normal and its line's
  double bridged_gap = 0.40;  ///< m, shorter gaps along a face are closed
  double min_length = 0.25;   ///< m, shorter faces are dropped
  int min_points = 20;        ///< of a face, after thinning
};

/// Wall faces just below the ceiling, where doors and furniture do not interrupt them.
/// `plan` is a cloud with normals in the plan frame.
std::vector<WallFace> find_wall_faces(const Cloud& plan, const FloorGrid& grid,
                                      const LevelSurface& ceiling,
                                      const WallFaceParams& params = {});

}  // namespace planum
