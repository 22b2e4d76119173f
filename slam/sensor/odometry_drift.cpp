#include "slam/sensor/odometry_drift.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/sensor/random_numbers.hpp"

namespace planum {
namespace {

void check_deviation(const char* option, double value) {
  if (!(value >= 0) || !std::isfinite(value))
    throw Error(fmt::format("{} is {}, must be at least 0", option, value));
}

void check(const DriftParams& params) {
  check_deviation("translation_per_metre", params.translation_per_metre);
  check_deviation("height_per_metre", params.height_per_metre);
  check_deviation("heading_per_metre", params.heading_per_metre);
  check_deviation("heading_per_radian", params.heading_per_radian);
  check_deviation("tilt_per_stop", params.tilt_per_stop);
  if (!std::isfinite(params.heading_bias_per_metre))
    throw Error("heading_bias_per_metre is not finite");
}

/// The error of one motion as a twist in the frame of its end.
Vector6d motion_error(const Pose& motion, const DriftParams& params, RandomNumbers& random) {
  const double distance = motion.translation().norm();
  const double turn = rotation_angle(motion);
  Vector6d error;
  error[0] = params.translation_per_metre * distance * random.normal();
  error[1] = params.translation_per_metre * distance * random.normal();
  error[2] = params.height_per_metre * distance * random.normal();
  error[3] = params.tilt_per_stop * random.normal();
  error[4] = params.tilt_per_stop * random.normal();
  error[5] = params.heading_bias_per_metre * distance +
             params.heading_per_metre * distance * random.normal() +
             params.heading_per_radian * turn * random.normal();
  return error;
}

}  // namespace

std::vector<Pose> drifted(std::span<const Pose> world_from_robot, const DriftParams& params) {
  check(params);
  std::vector<Pose> odometry;
  for (std::size_t i = 0; i < world_from_robot.size(); ++i) {
    if (i == 0) {
      odometry.push_back(world_from_robot[0]);
      continue;
    }
    const Pose motion = world_from_robot[i - 1].inverse() * world_from_robot[i];
    RandomNumbers random({params.seed, i});
    odometry.push_back(
        orthonormalized(odometry.back() * motion * exp_se3(motion_error(motion, params, random))));
  }
  return odometry;
}

}  // namespace planum
