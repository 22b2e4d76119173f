#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

/// How odometry goes wrong between two stops: standard deviations of normally distributed errors.
struct DriftParams {
  double translation_per_metre = 0.03;    ///< m/m, forward and sideways
  double height_per_metre = 0.003;        ///< m/m
  double heading_per_metre = 0.01;        ///< rad/m
  double heading_per_radian = 0.03;       ///< rad/rad of turning
  double heading_bias_per_metre = 0.004;  ///< rad/m, the same everywhere: unequal wheels
  double tilt_per_stop = 0.001;           ///< rad, roll and pitch each
  std::uint64_t seed = 1;
};

/// The path that odometry reports for a true path: the first pose is right, each motion from a
/// pose to the next has an error of its own, and errors add up. A robot that stands still reports
/// no heading or position error. Throws Error if a parameter is negative or not finite.
std::vector<Pose> drifted(std::span<const Pose> world_from_robot, const DriftParams& params = {});

}  // namespace planum
