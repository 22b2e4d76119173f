#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/trajectory.hpp"
#include "slam/evaluation/error_statistics.hpp"
#include "slam/evaluation/pose_matching.hpp"

namespace planum {

/// How an estimate is laid onto the truth before poses are compared.
enum class TrajectoryAlignment {
  none,        ///< not at all
  first_pose,  ///< by the first pose of each
  positions,   ///< by Umeyama's least squares of positions; joint where they leave a rotation open
  joint,       ///< by positions and orientations
};

struct TrajectoryErrorParams {
  double max_stamp_difference =
      0.01;  ///< of two poses that belong together, in units of the stamps
  TrajectoryAlignment alignment = TrajectoryAlignment::positions;
  double lever = 3.0;      ///< m, what 1 rad of orientation error weighs in joint alignment
  std::size_t delta = 1;   ///< poses between the two of a relative error
  bool all_pairs = false;  ///< relative errors for every pose, not only every delta-th
};

/// How far a trajectory is from the truth. Translations in m, rotations in degrees.
struct TrajectoryError {
  std::vector<std::pair<std::size_t, std::size_t>> matches;   ///< positions in estimate and truth
  TrajectoryAlignment alignment = TrajectoryAlignment::none;  ///< the one that was used
  Pose truth_from_estimate = Pose::Identity();
  ErrorStatistics ape_translation, ape_rotation;  ///< absolute pose error
  ErrorStatistics rpe_translation, rpe_rotation;  ///< relative pose error; count 0 if too few poses
  std::vector<double> ape_translations, ape_rotations;  ///< for each match
};

/// Absolute and relative pose errors as evo computes them. Throws Error if a pose or stamp is not
/// finite, no stamps belong together, or a parameter is out of range.
TrajectoryError trajectory_error(const Trajectory& estimate, const Trajectory& truth,
                                 const TrajectoryErrorParams& params = {});

}  // namespace planum
