#pragma once

#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

/// A pose and the key it goes by: the scan's number, or a time in seconds.
struct StampedPose {
  double stamp = 0;
  Pose pose = Pose::Identity();  ///< world_from_scan
};

using Trajectory = std::vector<StampedPose>;

}  // namespace planum
