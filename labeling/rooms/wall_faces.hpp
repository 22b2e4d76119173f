#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/plan/floor_grid.hpp"

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

/// A point on an upright surface, in the plan frame.
struct WallPoint {
  Eigen::Vector2d position;
  Eigen::Vector2d normal;  ///< unit
  double height = 0;       ///< m, z
};

struct WallFaceParams {
  double thickness = 0.05;    ///< m, points this near a line belong to it
  double max_turn = 0.40;     ///< rad between a point's normal and its line's
  double bridged_gap = 0.40;  ///< m, shorter gaps along a face are closed
  double min_length = 0.25;   ///< m, shorter faces are dropped
  int min_points = 20;        ///< of a face, after thinning
};

/// Straight faces through points, found one after the other: the fullest direction, the fullest
/// line of that direction, and the stretches of it that points cover.
std::vector<WallFace> find_wall_faces(const std::vector<WallPoint>& points, const FloorGrid& grid,
                                      const WallFaceParams& params = {});

}  // namespace planum
