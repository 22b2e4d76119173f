#include "slam/registration/sequence.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/registration/match_doubt.hpp"

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
  require(params.second_gate > 0, "second_gate", params.second_gate, "> 0 m");
  require(params.second_min_overlap > 0 && params.second_min_overlap <= 1, "second_min_overlap",
          params.second_min_overlap, "between 0 and 1");
  require(params.odometry.translation > 0, "odometry translation noise",
          params.odometry.translation, "> 0 m");
  require(params.odometry.rotation > 0, "odometry rotation noise",
          degrees(params.odometry.rotation), "> 0 deg");
  for (std::size_t i = 0; i < odometry.size(); ++i)
    if (!odometry[i].matrix().allFinite())
      throw Error(
          fmt::format("registration: the pose of scan {} of the sequence is not finite", i));
}

/// The matching of a sequence while it goes on.
class Sequence {
 public:
  using FirstAttempt = std::function<Alignment(std::span<const Pose> earlier, const Pose& guess)>;

  Sequence(FirstAttempt first, const SequenceParams& params, const SequenceAids& aids)
      : first_(std::move(first)), params_(params), aids_(aids) {}

  /// The step to the scan after the earlier ones.
  SequenceStep step(std::span<const Pose> earlier, const Pose& guess) const {
    const std::size_t target = earlier.size() - 1, source = earlier.size();
    SequenceStep step{.alignment = first_(earlier, guess)};
    step.reason = distrust(target, guess, step.alignment, params_.min_overlap);
    // A match of little overlap may be a wrong one that looks right: what has more is preferred.
    bool sure = step.reason.empty() && step.alignment.overlap >= params_.second_min_overlap;
    const auto attempt = [&](const std::optional<Alignment>& alignment) {
      if (!alignment || !distrust(target, guess, *alignment, params_.second_min_overlap).empty())
        return;
      step.alignment = *alignment;
      step.reason.clear();
      sure = true;
    };
    if (!sure && aids_.second) attempt(aids_.second(target, source, guess, params_.second_gate));
    if (!sure && aids_.metascan) attempt(aids_.metascan(earlier, guess, params_.second_gate));
    if (!sure && aids_.locate) attempt(aids_.locate(target, source));
    step.matched = step.reason.empty();
    if (!step.matched) step.alignment = {.target_from_source = guess};
    step.odometry_information = odometry_information(guess, params_.odometry);
    step.alignment.information += step.odometry_information;
    return step;
  }

 private:
  /// Empty if the match can be trusted.
  std::string distrust(std::size_t target, const Pose& guess, const Alignment& alignment,
                       double min_overlap) const {
    const Pose correction = guess.inverse() * alignment.target_from_source;
    const double shift = correction.translation().norm(), turn = rotation_angle(correction);
    if (std::string reason = doubt_of_match(alignment, min_overlap); !reason.empty()) return reason;
    if (params_.odometry_known && shift > params_.max_shift)
      return fmt::format("moved {:.2f} m, more than {:.2f} m", shift, params_.max_shift);
    if (params_.odometry_known && turn > params_.max_turn)
      return fmt::format("turned {:.1f} deg, more than {:.1f} deg", degrees(turn),
                         degrees(params_.max_turn));
    if (!aids_.contradicted) return {};
    return doubt_of_rays(aids_.contradicted(target, target + 1, alignment.target_from_source),
                         params_.max_contradicted);
  }

  FirstAttempt first_;
  const SequenceParams& params_;
  const SequenceAids& aids_;
};

SequenceMatch matched(std::span<const Pose> odometry, const Sequence& sequence,
                      const SequenceParams& params, const Progress& progress) {
  check(odometry, params);
  SequenceMatch result;
  if (odometry.empty()) return result;
  result.poses.push_back(odometry[0]);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const Pose guess = odometry[i - 1].inverse() * odometry[i];
    result.steps.push_back(sequence.step(result.poses, guess));
    result.poses.push_back(
        orthonormalized(result.poses.back() * result.steps.back().alignment.target_from_source));
    progress.report(i, odometry.size() - 1);
  }
  return result;
}

}  // namespace

Matrix6d odometry_information(const Pose& motion, const OdometryNoise& noise) {
  const double way = motion.translation().norm(), turn = rotation_angle(motion);
  const double translation = std::hypot(noise.translation, noise.translation_per_metre * way);
  const double rotation =
      std::hypot(noise.rotation, noise.rotation_per_radian * turn, noise.rotation_per_metre * way);
  return both_parts(1 / (translation * translation), 1 / (rotation * rotation)).asDiagonal();
}

SequenceMatch match_in_order(std::span<const Pose> odometry, const PairMatcher& matcher,
                             const SequenceParams& params, const Progress& progress,
                             const SequenceAids& aids) {
  const auto first = [&](std::span<const Pose> earlier, const Pose& guess) {
    return matcher(earlier.size() - 1, earlier.size(), guess);
  };
  return matched(odometry, Sequence(first, params, aids), params, progress);
}

SequenceMatch match_to_metascan(std::span<const Pose> odometry, const MetascanMatcher& matcher,
                                const SequenceParams& params, const Progress& progress,
                                const SequenceAids& aids) {
  const auto first = [&](std::span<const Pose> earlier, const Pose& guess) {
    return matcher(earlier, guess, 0);
  };
  return matched(odometry, Sequence(first, params, aids), params, progress);
}

}  // namespace planum
