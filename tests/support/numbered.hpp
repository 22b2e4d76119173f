#pragma once

#include <vector>

#include "slam/core/trajectory.hpp"

namespace planum::testing {

/// Poses as a trajectory, numbered from 0.
inline Trajectory numbered(const std::vector<Pose>& poses) {
  Trajectory result;
  for (const Pose& pose : poses) result.push_back({static_cast<double>(result.size()), pose});
  return result;
}

}  // namespace planum::testing
