#include "slam/graph/loop_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>

#include "slam/core/parallel.hpp"
#include "slam/graph/path_covariance.hpp"
#include "slam/graph/place_search.hpp"
#include "slam/registration/overlap.hpp"

namespace planum {
namespace {

/// A gate reaches this many standard deviations of the guess.
constexpr double gate_per_deviation = 3;

std::optional<LoopCandidate> considered(std::span<const MatchingScan> scans, LoopCandidate pair,
                                        const WorthATry& worth_a_try, const LoopParams& params) {
  if (pair.guess.translation().norm() > params.max_distance ||
      placed_within(pair.covariance, scans[pair.to].radius) < params.known_within ||
      !worth_a_try(pair))
    return std::nullopt;
  const OverlapParams near{.distance = pair.gate(params)};
  const MatchingScan &from = scans[pair.from], &to = scans[pair.to];
  pair.overlap = std::max(estimated_overlap(to, from, pair.guess, near),
                          estimated_overlap(from, to, pair.guess.inverse(), near));
  if (pair.overlap < params.min_overlap) return std::nullopt;
  return pair;
}

std::vector<LoopCandidate> most_overlapping(const std::vector<LoopCandidate>& all,
                                            std::size_t scans, std::size_t per_scan) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return all[x].overlap > all[y].overlap; });
  std::vector<std::size_t> count(scans, 0);
  std::vector<LoopCandidate> result;
  for (const std::size_t k : order) {
    const LoopCandidate& pair = all[k];
    if (std::min(count[pair.from], count[pair.to]) >= per_scan) continue;
    ++count[pair.from];
    ++count[pair.to];
    result.push_back(pair);
  }
  return result;
}

}  // namespace

double placed_within(const Matrix6d& covariance, double radius) {
  const double shift = covariance.diagonal().head<3>().maxCoeff();
  const double turn = covariance.diagonal().tail<3>().maxCoeff();
  return std::sqrt(shift + radius * radius * turn);
}

double LoopCandidate::gate(const LoopParams& params) const {
  return std::clamp(gate_per_deviation * placed_within(covariance, 0), params.least_gate,
                    params.most_gate);
}

Matrix6d step_noise(const LoopParams& params) {
  return both_parts(params.step_translation * params.step_translation,
                    params.step_rotation * params.step_rotation)
      .asDiagonal();
}

Matrix6d unknown_pose(const LoopParams& params) {
  return both_parts(params.most_gate * params.most_gate, (pi / 4) * (pi / 4)).asDiagonal();
}

std::vector<LoopCandidate> loop_candidates(std::span<const MatchingScan> scans,
                                           const PoseGraph& graph, const WorthATry& worth_a_try,
                                           std::size_t per_scan, const LoopParams& params) {
  const PathCovariances paths(graph, step_noise(params));
  std::vector<std::vector<LoopCandidate>> of_scan(scans.size());
  parallel_for(scans.size(), 1, [&](std::size_t from, std::size_t) {
    const auto covariances = paths.from(from);
    for (std::size_t to = from + 2; to < scans.size(); ++to) {
      const LoopCandidate pair{.from = from,
                               .to = to,
                               .guess = graph.poses[from].inverse() * graph.poses[to],
                               .covariance = covariances[to].value_or(unknown_pose(params))};
      if (const auto candidate = considered(scans, pair, worth_a_try, params))
        of_scan[from].push_back(*candidate);
    }
  });
  std::vector<LoopCandidate> all;
  for (const auto& some : of_scan) all.insert(all.end(), some.begin(), some.end());
  return most_overlapping(all, scans.size(), per_scan);
}

std::vector<LoopCandidate> candidates_by_appearance(std::span<const MatchingScan> scans,
                                                    const PoseGraph& graph,
                                                    const LoopParams& params,
                                                    const Progress& progress) {
  const PathCovariances paths(graph, step_noise(params));
  const auto is_open = [&](const std::optional<Matrix6d>& covariance) {
    return placed_within(covariance.value_or(unknown_pose(params)), 0) >= params.most_gate;
  };
  std::vector<std::uint8_t> has_open(scans.size(), 0);
  parallel_for(scans.size(), 1, [&](std::size_t from, std::size_t) {
    const auto covariances = paths.from(from);
    const auto later = covariances.begin() + static_cast<std::ptrdiff_t>(from) + 1;
    has_open[from] = std::any_of(later, covariances.end(), is_open);
  });
  if (std::find(has_open.begin(), has_open.end(), 1) == has_open.end()) return {};
  std::map<std::size_t, std::vector<std::optional<Matrix6d>>> covariances_from;
  std::vector<LoopCandidate> result;
  for (const PlaceCandidate& place : find_places(scans, {}, progress)) {
    if (!has_open[place.target] || place.source < place.target + 2) continue;
    auto& covariances = covariances_from[place.target];
    if (covariances.empty()) covariances = paths.from(place.target);
    if (!is_open(covariances[place.source])) continue;
    const Matrix6d covariance = covariances[place.source].value_or(unknown_pose(params));
    result.push_back({.from = place.target,
                      .to = place.source,
                      .guess = graph.poses[place.target].inverse() * graph.poses[place.source],
                      .start = place.target_from_source,
                      .covariance = covariance,
                      .overlap = place.score});
  }
  return result;
}

}  // namespace planum
