#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "slam/core/trajectory.hpp"

namespace planum {

/// Pairs of poses with the nearest stamps, not farther apart than max_difference: for each pose of
/// the shorter trajectory (the estimate if they are as long) its nearest one in the other.
std::vector<std::pair<std::size_t, std::size_t>> associated(const Trajectory& estimate,
                                                            const Trajectory& truth,
                                                            double max_difference);

/// Estimated and true poses that belong together; lists of one length.
struct MatchedPoses {
  std::vector<std::pair<std::size_t, std::size_t>> matches;  ///< positions in the trajectories
  std::vector<Pose> estimate, truth;
};

/// Throws Error if a pose or stamp is not finite, max_difference is negative, or no stamps belong
/// together.
MatchedPoses matched_poses(const Trajectory& estimate, const Trajectory& truth,
                           double max_difference);

/// Throws Error if a pose or stamp of a trajectory is not finite; `name` is for the message.
void check_finite(const Trajectory& trajectory, const char* name);

}  // namespace planum
