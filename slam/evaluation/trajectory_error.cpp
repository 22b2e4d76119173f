#include "slam/evaluation/trajectory_error.hpp"

#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/alignment.hpp"

namespace planum {
namespace {

void check(const TrajectoryErrorParams& params) {
  if (!(params.lever > 0))
    throw Error(fmt::format("evaluation: lever must be > 0 m, got {}", params.lever));
  if (params.delta == 0) throw Error("evaluation: delta must be > 0, got 0");
}

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

}  // namespace

TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth,
                                 const TrajectoryErrorParams& params) {
  check(params);
  const MatchedPoses poses = matched_poses(estimate, truth, params.max_stamp_difference);
  TrajectoryError result;
  result.matches = poses.matches;
  result.alignment = params.alignment;
  result.truth_from_estimate = truth_from_estimate(poses, params.lever, result.alignment);
  add_absolute_errors(poses, result);
  add_relative_errors(poses, params, result);
  return result;
}

}  // namespace planum
