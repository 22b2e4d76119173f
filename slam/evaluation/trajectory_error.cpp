#include "slam/evaluation/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/alignment.hpp"

namespace planum {
namespace {

void check(const Trajectory& trajectory, const std::string& name) {
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    if (!std::isfinite(trajectory[i].stamp) || !trajectory[i].pose.matrix().allFinite())
      throw Error(fmt::format("evaluation: pose {} of the {} is not finite", i, name));
}

void check(const TrajectoryErrorParams& params) {
  if (!(params.max_stamp_difference >= 0))
    throw Error(fmt::format("evaluation: max_stamp_difference must be >= 0, got {}",
                            params.max_stamp_difference));
  if (!(params.lever > 0))
    throw Error(fmt::format("evaluation: lever must be > 0 m, got {}", params.lever));
  if (params.delta == 0) throw Error("evaluation: delta must be > 0, got 0");
}

/// Estimated and true poses that belong together.
struct MatchedPoses {
  std::vector<Pose> estimate, truth;
};

/// Sets `alignment` to what is used in the end.
Pose truth_from_estimate(const MatchedPoses& poses, double lever, TrajectoryAlignment& alignment) {
  if (alignment == TrajectoryAlignment::none) return Pose::Identity();
  if (alignment == TrajectoryAlignment::first_pose)
    return poses.truth.front() * poses.estimate.front().inverse();
  if (alignment == TrajectoryAlignment::positions) {
    std::vector<Eigen::Vector3d> estimate, truth;
    for (const Pose& pose : poses.estimate) estimate.push_back(pose.translation());
    for (const Pose& pose : poses.truth) truth.push_back(pose.translation());
    if (const std::optional<Pose> pose = umeyama_alignment(estimate, truth)) return *pose;
    alignment = TrajectoryAlignment::joint;
  }
  return joint_alignment(poses.estimate, poses.truth, lever);
}

void add_absolute_errors(const MatchedPoses& poses, TrajectoryError& result) {
  for (std::size_t i = 0; i < poses.estimate.size(); ++i) {
    const Pose aligned = result.truth_from_estimate * poses.estimate[i];
    result.ape_translations.push_back(
        (aligned.translation() - poses.truth[i].translation()).norm());
    result.ape_rotations.push_back(degrees(rotation_angle(aligned, poses.truth[i])));
  }
  result.ape_translation = statistics(result.ape_translations);
  result.ape_rotation = statistics(result.ape_rotations);
}

/// Sturm et al. (IROS 2012): E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q true, P estimated.
void add_relative_errors(const MatchedPoses& poses, const TrajectoryErrorParams& params,
                         TrajectoryError& result) {
  std::vector<double> translations, rotations;
  const std::size_t stride = params.all_pairs ? 1 : params.delta;
  for (std::size_t i = 0; i + params.delta < poses.truth.size(); i += stride) {
    const std::size_t j = i + params.delta;
    const Pose true_motion = poses.truth[i].inverse() * poses.truth[j];
    const Pose motion = poses.estimate[i].inverse() * poses.estimate[j];
    const Pose error = true_motion.inverse() * motion;
    translations.push_back(error.translation().norm());
    rotations.push_back(degrees(rotation_angle(error)));
  }
  result.rpe_translation = statistics(translations);
  result.rpe_rotation = statistics(rotations);
}

/// Position of the pose with the nearest stamp; the first one of several.
std::size_t nearest(const Trajectory& trajectory, double stamp) {
  const auto found = std::min_element(
      trajectory.begin(), trajectory.end(), [&](const StampedPose& a, const StampedPose& b) {
        return std::abs(a.stamp - stamp) < std::abs(b.stamp - stamp);
      });
  return static_cast<std::size_t>(found - trajectory.begin());
}

}  // namespace

ErrorStatistics statistics(std::span<const double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  result.count = errors.size();
  const double count = static_cast<double>(errors.size());
  double sum = 0;
  for (const double e : errors) {
    sum += e;
    result.sse += e * e;
  }
  result.mean = sum / count;
  result.rmse = std::sqrt(result.sse / count);
  double squared = 0;
  for (const double e : errors) squared += (e - result.mean) * (e - result.mean);
  result.std = std::sqrt(squared / count);
  std::vector<double> sorted(errors.begin(), errors.end());
  std::sort(sorted.begin(), sorted.end());
  result.min = sorted.front();
  result.max = sorted.back();
  result.median = (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
  return result;
}

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

TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth,
                                 const TrajectoryErrorParams& params) {
  check(params);
  check(estimate, "estimate");
  check(truth, "truth");
  TrajectoryError result;
  result.matches = associated(estimate, truth, params.max_stamp_difference);
  result.alignment = params.alignment;
  if (result.matches.empty())
    throw Error(
        fmt::format("evaluation: none of the {} poses has a true one whose stamp is within "
                    "{} of its own (there are {} true poses)",
                    estimate.size(), params.max_stamp_difference, truth.size()));
  MatchedPoses poses;
  for (const auto& [e, t] : result.matches) {
    poses.estimate.push_back(estimate[e].pose);
    poses.truth.push_back(truth[t].pose);
  }
  result.truth_from_estimate = truth_from_estimate(poses, params.lever, result.alignment);
  add_absolute_errors(poses, result);
  add_relative_errors(poses, params, result);
  return result;
}

}  // namespace planum
