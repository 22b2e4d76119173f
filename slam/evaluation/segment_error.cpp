#include "slam/evaluation/segment_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/pose_matching.hpp"

namespace planum {
namespace {

/// Of a length: sums of the same steps may differ by rounding.
constexpr double slack = 1e-9;

void check(const SegmentErrorParams& params) {
  for (const double length : params.lengths)
    if (!(length > 0) || !std::isfinite(length))
      throw Error(fmt::format("evaluation: lengths must be > 0 m, got {}", length));
  if (params.stride == 0) throw Error("evaluation: stride must be > 0, got 0");
}

/// The poses in the order of their true stamps.
MatchedPoses in_order(const MatchedPoses& poses, const Trajectory& truth) {
  std::vector<std::size_t> order(poses.matches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return truth[poses.matches[a].second].stamp < truth[poses.matches[b].second].stamp;
  });
  MatchedPoses result;
  for (const std::size_t i : order) {
    result.matches.push_back(poses.matches[i]);
    result.estimate.push_back(poses.estimate[i]);
    result.truth.push_back(poses.truth[i]);
  }
  return result;
}

/// m, the way along the path to each pose.
std::vector<double> ways_to(const std::vector<Pose>& path) {
  std::vector<double> ways = {0};
  for (std::size_t i = 1; i < path.size(); ++i)
    ways.push_back(ways.back() + (path[i].translation() - path[i - 1].translation()).norm());
  return ways;
}

std::vector<double> lengths_that_fit(const std::vector<double>& ways) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < ways.size(); ++i) steps.push_back(ways[i] - ways[i - 1]);
  std::sort(steps.begin(), steps.end());
  std::vector<double> lengths;
  if (!(ways.back() > 0)) return lengths;
  const double least = quantile(steps, 0.5) * (1 - slack), most = ways.back() * (1 + slack);
  const int last_power = static_cast<int>(std::floor(std::log10(most)));
  // Steps are no shorter than a thousandth of a path that is worth segments.
  for (int power = last_power - 3; power <= last_power; ++power)
    for (const double digit : {1, 2, 5})
      if (const double length = digit * std::pow(10, power); length >= least && length <= most)
        lengths.push_back(length);
  return lengths;
}

struct Drifts {
  std::vector<double> paths, translations, rotations;
};

Drifts drifts_of(const MatchedPoses& poses, const std::vector<double>& ways, double length,
                 std::size_t stride) {
  Drifts drifts;
  for (std::size_t i = 0; i < ways.size(); i += stride) {
    const auto end = std::lower_bound(ways.begin(), ways.end(), ways[i] + length * (1 - slack));
    if (end == ways.end()) break;
    const auto j = static_cast<std::size_t>(end - ways.begin());
    const double path = ways[j] - ways[i];
    const Pose error = (poses.truth[i].inverse() * poses.truth[j]).inverse() *
                       (poses.estimate[i].inverse() * poses.estimate[j]);
    drifts.paths.push_back(path);
    drifts.translations.push_back(error.translation().norm() / path);
    drifts.rotations.push_back(degrees(rotation_angle(error)) / path);
  }
  return drifts;
}

}  // namespace

SegmentError segment_error(const Trajectory& estimate, const Trajectory& truth,
                           const SegmentErrorParams& params) {
  check(params);
  const MatchedPoses poses =
      in_order(matched_poses(estimate, truth, params.max_stamp_difference), truth);
  const std::vector<double> ways = ways_to(poses.truth);
  SegmentError result;
  result.path = ways.back();
  std::vector<double> translations, rotations;
  for (const double length : params.lengths.empty() ? lengths_that_fit(ways) : params.lengths) {
    const Drifts drifts = drifts_of(poses, ways, length, params.stride);
    if (drifts.paths.empty()) continue;
    translations.insert(translations.end(), drifts.translations.begin(), drifts.translations.end());
    rotations.insert(rotations.end(), drifts.rotations.begin(), drifts.rotations.end());
    result.lengths.push_back({.length = length,
                              .mean_path = statistics(drifts.paths).mean,
                              .translation = statistics(drifts.translations),
                              .rotation = statistics(drifts.rotations)});
  }
  result.translation = statistics(translations);
  result.rotation = statistics(rotations);
  return result;
}

}  // namespace planum
