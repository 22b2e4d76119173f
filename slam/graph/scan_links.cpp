#include "slam/graph/scan_links.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/parallel.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/normal_equations.hpp"
#include "slam/registration/overlap.hpp"

namespace planum {
namespace {

/// Adds what pairs in the frame of `target` say about the motion of the source against it.
/// `sign` is +1 if the source is scan a of the link, else -1.
void add(std::span<const Pair> pairs, Pairing pairing, double redundancy,
         const Pose& world_from_target, double sign, LinkFit& fit) {
  const NormalEquations equations = normal_equations(pairs, pairing);
  const Determined system = determined(equations);
  const Matrix6d local_from_world =
      twist_about(equations.centre) * adjoint(world_from_target.inverse());
  const double per_variance = 1 / (equations.residual_variance() * redundancy);
  fit.equation.information +=
      per_variance * local_from_world.transpose() * system.hessian * local_from_world;
  fit.equation.weighted_difference -=
      sign * per_variance * local_from_world.transpose() * system.gradient;
  fit.squared_residuals += equations.squared_residuals;
  fit.weight += equations.weight;
  fit.pairs += equations.pairs;
}

}  // namespace

std::vector<ScanPair> overlapping_scans(std::span<const MatchingScan> scans,
                                        const std::vector<Pose>& world_from_scan,
                                        const OverlapChoice& choice,
                                        const std::set<ScanPair>& excluded) {
  std::vector<ScanPair> near;
  for (std::size_t b = 1; b < scans.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if ((world_from_scan[a].translation() - world_from_scan[b].translation()).norm() <=
              choice.max_distance &&
          !excluded.contains({a, b}))
        near.emplace_back(a, b);
  std::vector<double> overlap(near.size());
  parallel_for(near.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto [a, b] = near[k];
      const Pose a_from_b = world_from_scan[a].inverse() * world_from_scan[b];
      overlap[k] = std::max(estimated_overlap(scans[b], scans[a], a_from_b),
                            estimated_overlap(scans[a], scans[b], a_from_b.inverse()));
    }
  });
  std::vector<std::vector<std::size_t>> of_scan(scans.size());
  for (std::size_t k = 0; k < near.size(); ++k)
    if (overlap[k] >= choice.min_overlap) {
      of_scan[near[k].first].push_back(k);
      of_scan[near[k].second].push_back(k);
    }
  std::set<ScanPair> chosen;
  for (std::vector<std::size_t>& candidates : of_scan) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](std::size_t x, std::size_t y) { return overlap[x] > overlap[y]; });
    candidates.resize(std::min(candidates.size(), choice.links_per_scan));
    for (const std::size_t k : candidates) chosen.insert(near[k]);
  }
  return {chosen.begin(), chosen.end()};
}

double LinkFit::rms() const { return weight > 0 ? std::sqrt(squared_residuals / weight) : 0; }

ScanLink::ScanLink(const ScanPair& pair, std::span<const MatchingScan> scans,
                   std::span<const std::vector<std::uint32_t>> selections)
    : pair_(pair),
      noise_(pair_noise(scans[pair.first], scans[pair.second])),
      spacing_(std::max(scans[pair.first].spacing, scans[pair.second].spacing)),
      a_in_b_(scans[pair.first], scans[pair.second], selections[pair.first]),
      b_in_a_(scans[pair.second], scans[pair.first], selections[pair.second]) {}

void ScanLink::select(std::span<const std::vector<std::uint32_t>> selections) {
  a_in_b_.select(selections[pair_.first]);
  b_in_a_.select(selections[pair_.second]);
}

LinkFit ScanLink::fit(const std::vector<Pose>& world_from_scan, Pairing pairing, double gate,
                      double max_normal_angle, std::size_t min_pairs) {
  const Pose &world_from_a = world_from_scan[pair_.first],
             &world_from_b = world_from_scan[pair_.second];
  const PairGate pair_gate = icp_gate(gate, spacing_, max_normal_angle);
  LinkFit result{.equation = {.a = pair_.first, .b = pair_.second}};
  const Pose b_from_a = world_from_b.inverse() * world_from_a;
  const std::vector<Pair> forth = a_in_b_.find(b_from_a, pairing, pair_gate);
  const std::vector<Pair> back = b_in_a_.find(b_from_a.inverse(), pairing, pair_gate);
  if (forth.size() >= min_pairs)
    add(forth, pairing, a_in_b_.redundancy(pairing), world_from_b, 1, result);
  if (back.size() >= min_pairs)
    add(back, pairing, b_in_a_.redundancy(pairing), world_from_a, -1, result);
  result.overlap =
      static_cast<double>(result.pairs) /
      static_cast<double>(std::max<std::size_t>(a_in_b_.selected() + b_in_a_.selected(), 1));
  return result;
}

}  // namespace planum
