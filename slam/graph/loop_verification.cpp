#include "slam/graph/loop_verification.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "slam/graph/path_covariance.hpp"
#include "slam/registration/match_doubt.hpp"

namespace planum {
namespace {

/// A candidate whose gate is so many least gates wide is matched from several starts.
constexpr double gates_of_one_start = 2;
/// Other starts lie so many standard deviations along the direction the path knows least.
constexpr double start_deviation = 1.5;
/// With less than so much of the overlap that is needed, other starts are not tried.
constexpr double hopeless = 0.5;
/// Matches that end nearer to each other than this are one place.
constexpr double same_place = 0.2;  // m
const double same_heading = radians(3);
/// A place fits as well as another with at least so much of its overlap, and at most so much rms.
constexpr double as_much_overlap = 0.9, as_little_rms = 1.25;

bool usable(const Alignment& alignment, const LoopParams& params) {
  return doubt_of_match(alignment, params.min_overlap).empty();
}

std::vector<Pose> starts(const LoopCandidate& candidate, const LoopParams& params) {
  std::vector<Pose> result = {candidate.start.value_or(candidate.guess)};
  if (candidate.start || candidate.gate(params) <= gates_of_one_start * params.least_gate)
    return result;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      candidate.covariance.topLeftCorner<3, 3>());
  const double most = params.most_gate / 2;
  const double reach = std::min(most, start_deviation * std::sqrt(axes.eigenvalues()[2]));
  for (const double side : {-1.0, 1.0})
    result.push_back(candidate.guess *
                     Pose(Eigen::Translation3d(side * reach * axes.eigenvectors().col(2))));
  return result;
}

/// The best of all matches, and in `reason` whether another place fits as well.
Alignment best_match(const LoopCandidate& candidate, const GatedPairMatcher& matcher,
                     const LoopParams& params, std::string& reason) {
  std::vector<Alignment> matches;
  for (const Pose& start : starts(candidate, params)) {
    matches.push_back(matcher(candidate.from, candidate.to, start, candidate.gate(params)));
    if (matches.front().overlap < hopeless * params.min_overlap) break;
  }
  Alignment best = matches.front();
  for (const Alignment& match : matches)
    if (usable(match, params) && (!usable(best, params) || match.overlap > best.overlap))
      best = match;
  if (!usable(best, params)) return best;
  for (const Alignment& match : matches) {
    if (!usable(match, params) || match.overlap < as_much_overlap * best.overlap ||
        match.rms > as_little_rms * best.rms)
      continue;
    const Pose between = best.target_from_source.inverse() * match.target_from_source;
    if (between.translation().norm() < same_place && rotation_angle(between) < same_heading)
      continue;
    reason = fmt::format("a place {:.2f} m and {:.1f} deg from there fits as well",
                         between.translation().norm(), degrees(rotation_angle(between)));
  }
  return best;
}

/// Empty if the match is to be believed.
std::string doubt(const LoopCandidate& candidate, const Alignment& alignment,
                  const LoopEvidence& evidence, const LoopParams& params) {
  if (const std::string reason = doubt_of_match(alignment, params.min_overlap); !reason.empty())
    return reason;
  if (evidence.usual_rms > 0 && alignment.rms > params.max_rms_ratio * evidence.usual_rms)
    return fmt::format("rms {:.4f} m is above {:.4f} m", alignment.rms,
                       params.max_rms_ratio * evidence.usual_rms);
  const Vector6d correction = log_se3(candidate.guess.inverse() * alignment.target_from_source);
  const double off = deviation(correction, candidate.covariance + step_noise(params));
  if (off > params.max_deviation)
    return fmt::format("{:.2f} m and {:.1f} deg off the path, {:.1f} standard deviations",
                       correction.head<3>().norm(), degrees(correction.tail<3>().norm()), off);
  return doubt_of_rays(
      check_free_space(evidence.to, evidence.from, alignment.target_from_source).contradicted(),
      params.max_contradicted);
}

}  // namespace

Edge verified_loop(const LoopCandidate& candidate, const GatedPairMatcher& matcher,
                   const LoopEvidence& evidence, const LoopParams& params) {
  std::string ambiguity;
  const Alignment alignment = best_match(candidate, matcher, params, ambiguity);
  Edge edge{.from = candidate.from,
            .to = candidate.to,
            .from_from_to = alignment.target_from_source,
            .information = alignment.information,
            .rms = alignment.rms,
            .overlap = alignment.overlap,
            .kind = EdgeKind::loop};
  edge.reason = doubt(candidate, alignment, evidence, params);
  if (edge.reason.empty()) edge.reason = ambiguity;
  edge.accepted = edge.reason.empty();
  return edge;
}

}  // namespace planum
