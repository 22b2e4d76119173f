#include "slam/core/planar_pose.hpp"

#include <cmath>

namespace planum {

Pose lifted(const PlanarPose& pose) {
  return pose_from_xyz_ypr({pose.position.x(), pose.position.y(), 0}, pose.heading, 0, 0);
}

PlanarPose flattened(const Pose& pose) {
  return {.position = pose.translation().head<2>(),
          .heading = std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

}  // namespace planum
