#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "slam/core/pose.hpp"

namespace planum {

/// What an inclinometer says about one pose of a graph: where up is.
struct GravityObservation {
  std::size_t pose = 0;
  Eigen::Vector3d up_in_pose = Eigen::Vector3d::UnitZ();  ///< measured; any length but zero
  double sigma = radians(0.5);                            ///< rad, of the measurement
};

}  // namespace planum
