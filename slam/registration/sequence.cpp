#include "slam/registration/sequence.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(std::span<const Pose> odometry, const SequenceParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good)
      throw Error(fmt::format("registration: {} must be {}, got {}", option, limit, value));
  };
  require(params.min_overlap > 0 && params.min_overlap <= 1, "min_overlap", params.min_overlap,
          "between 0 and 1");
  require(params.max_shift > 0, "max_shift", params.max_shift, "> 0 m");
  require(params.max_turn > 0, "max_turn", degrees(params.max_turn), "> 0 deg");
  require(params.odometry.translation > 0, "odometry translation noise",
          params.odometry.translation, "> 0 m");
  require(params.odometry.rotation > 0, "odometry rotation noise",
          degrees(params.odometry.rotation), "> 0 deg");
  for (std::size_t i = 0; i < odometry.size(); ++i)
    if (!odometry[i].matrix().allFinite())
      throw Error(
          fmt::format("registration: the pose of scan {} of the sequence is not finite", i));
}

/// Empty if the match can be trusted.
std::string distrust(const Alignment& alignment, const Pose& guess, const SequenceParams& params) {
  const Pose correction = guess.inverse() * alignment.target_from_source;
  const double shift = correction.translation().norm(), turn = rotation_angle(correction);
  if (alignment.pairs == 0) return "too few pairs";
  if (alignment.overlap < params.min_overlap)
    return fmt::format("overlap {:.2f} is below {:.2f}", alignment.overlap, params.min_overlap);
  if (!alignment.converged) return "the match did not converge";
  if (shift > params.max_shift)
    return fmt::format("moved {:.2f} m, more than {:.2f} m", shift, params.max_shift);
  if (turn > params.max_turn)
    return fmt::format("turned {:.1f} deg, more than {:.1f} deg", degrees(turn),
                       degrees(params.max_turn));
  return {};
}

}  // namespace

PairMatcher icp_matcher(std::span<const MatchingScan> scans, const IcpParams& params) {
  return [scans, params](std::size_t target, std::size_t source, const Pose& guess) {
    try {
      return align(scans[source], scans[target], guess, params);
    } catch (Error& error) {
      error.add_context(fmt::format("matching scan {} with scan {}", source, target));
      throw;
    }
  };
}

Matrix6d odometry_information(const Pose& motion, const OdometryNoise& noise) {
  const double way = motion.translation().norm(), turn = rotation_angle(motion);
  const double translation = std::hypot(noise.translation, noise.translation_per_metre * way);
  const double rotation =
      std::hypot(noise.rotation, noise.rotation_per_radian * turn, noise.rotation_per_metre * way);
  Vector6d information;
  information << Eigen::Vector3d::Constant(1 / (translation * translation)),
      Eigen::Vector3d::Constant(1 / (rotation * rotation));
  return information.asDiagonal();
}

SequenceMatch match_in_order(std::span<const Pose> odometry, const PairMatcher& matcher,
                             const SequenceParams& params, const Progress& progress) {
  check(odometry, params);
  SequenceMatch result;
  if (odometry.empty()) return result;
  result.poses.push_back(odometry[0]);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const Pose guess = odometry[i - 1].inverse() * odometry[i];
    SequenceStep step{.alignment = matcher(i - 1, i, guess)};
    step.reason = distrust(step.alignment, guess, params);
    step.matched = step.reason.empty();
    if (!step.matched) {
      step.alignment.target_from_source = guess;
      step.alignment.information.setZero();
    }
    step.odometry_information = odometry_information(guess, params.odometry);
    step.alignment.information += step.odometry_information;
    result.poses.push_back(
        orthonormalized(result.poses.back() * step.alignment.target_from_source));
    result.steps.push_back(std::move(step));
    progress.report(i, odometry.size() - 1);
  }
  return result;
}

}  // namespace planum
