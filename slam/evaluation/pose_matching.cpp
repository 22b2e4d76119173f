#include "slam/evaluation/pose_matching.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

/// Position of the pose with the nearest stamp; the first one of several.
std::size_t nearest(const Trajectory& trajectory, double stamp) {
  const auto found = std::min_element(
      trajectory.begin(), trajectory.end(), [&](const StampedPose& a, const StampedPose& b) {
        return std::abs(a.stamp - stamp) < std::abs(b.stamp - stamp);
      });
  return static_cast<std::size_t>(found - trajectory.begin());
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> associated(const Trajectory& estimate,
                                                            const Trajectory& truth,
                                                            double max_difference) {
  std::vector<std::pair<std::size_t, std::size_t>> matches;
  if (estimate.empty() || truth.empty()) return matches;
  const bool truth_is_longer = truth.size() >= estimate.size();
  const Trajectory& shorter = truth_is_longer ? estimate : truth;
  const Trajectory& longer = truth_is_longer ? truth : estimate;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = nearest(longer, shorter[i].stamp);
    if (std::abs(longer[j].stamp - shorter[i].stamp) > max_difference) continue;
    matches.emplace_back(truth_is_longer ? i : j, truth_is_longer ? j : i);
  }
  return matches;
}

void check_finite(const Trajectory& trajectory, const char* name) {
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (!std::isfinite(trajectory[i].stamp) || !trajectory[i].pose.matrix().allFinite())
      throw Error(fmt::format("evaluation: pose {} of the {} is not finite", i, name));
}

MatchedPoses matched_poses(const Trajectory& estimate, const Trajectory& truth,
                           double max_difference) {
  if (!(max_difference >= 0))
    throw Error(
        fmt::format("evaluation: max_stamp_difference must be >= 0, got {}", max_difference));
  check_finite(estimate, "estimate");
  check_finite(truth, "truth");
  MatchedPoses poses;
  poses.matches = associated(estimate, truth, max_difference);
  if (poses.matches.empty())
    throw Error(
        fmt::format("evaluation: none of the {} poses has a true one whose stamp is within "
                    "{} of its own (there are {} true poses)",
                    estimate.size(), max_difference, truth.size()));
  for (const auto& [e, t] : poses.matches) {
    poses.estimate.push_back(estimate[e].pose);
    poses.truth.push_back(truth[t].pose);
  }
  return poses;
}

}  // namespace planum
