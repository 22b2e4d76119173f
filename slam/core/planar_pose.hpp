#pragma once

#include <Eigen/Core>

#include "slam/core/pose.hpp"

namespace planum {

/// A pose in the plane; named `b_from_a` as poses in space are.
struct PlanarPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double heading = 0;                                  ///< rad, counter-clockwise
};

/// The pose in space with z = 0 that only turns about z.
Pose lifted(const PlanarPose& pose);

/// The pose in the plane below a pose in space.
PlanarPose flattened(const Pose& pose);

}  // namespace planum
