#include "slam/graph/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t evidence_samples = 1500, rough_samples = 200;
constexpr float rough_distance = 0.25f;  ///< m
constexpr float near_surface = 0.2f;     ///< m
constexpr double least_touching = 0.02;  ///< m, scans are bent by so much
constexpr double touching_per_noise = 3;
constexpr float least_alike = 0.7f;        ///< cosine between normals of one surface
constexpr double rough_gate = 0.6;         ///< m, poses of plans are good to about half of it
constexpr double last_first_gate = 0.3;    ///< m, of the match that the rough one leads to
constexpr double same_shift = 0.3;         ///< m, poses nearer than this are one ...
constexpr double same_turn = radians(5);   ///< rad, ... if turned by no more
constexpr std::size_t compared_poses = 8;  ///< of those that plans give, are looked at in space
/// Contradictions that make a pose e times less likely: right poses have a third of it, or as much
/// where scans are bent; where a pose is only rough, more.
constexpr double contradiction_scale = 0.015, rough_contradiction_scale = 0.05;

void require(bool good, const char* option, double value, const char* limit) {
  if (!good) throw Error(fmt::format("place search: {} must be {}, got {}", option, limit, value));
}

bool is_share(double value) { return value >= 0 && value <= 1; }

void check(const LocateParams& params) {
  require(is_share(params.min_overlap), "min_overlap", params.min_overlap, "between 0 and 1");
  require(is_share(params.min_closeness), "min_closeness", params.min_closeness, "between 0 and 1");
  require(is_share(params.min_support), "min_support", params.min_support, "between 0 and 1");
  require(is_share(params.max_contradicted), "max_contradicted", params.max_contradicted,
          "between 0 and 1");
  require(params.max_rival > 0 && params.max_rival <= 1, "max_rival", params.max_rival,
          "above 0, at most 1");
}

/// Every n-th sample, so that about so many are taken.
std::size_t step_of(const RangeView& view, std::size_t samples) {
  return std::max<std::size_t>(1, view.samples.size() / samples);
}

/// The local plane of the point next to a sample, if it faces the same way.
const LocalPlane* plane_near(const RangeView::Sample& sample, const MatchingScan& scan,
                             float distance) {
  const auto found = scan.tree.nearest(sample.point, distance);
  if (!found) return nullptr;
  const LocalPlane& plane = scan.planes[found->index];
  return plane.known() && sample.normal.dot(plane.normal) > least_alike ? &plane : nullptr;
}

RangeView::Sample moved(const RangeView::Sample& sample, const Eigen::Isometry3f& pose) {
  return {pose * sample.point, pose.linear() * sample.normal};
}

/// The share of the source's surfaces that have the target's near them, one way.
double rough_overlap(const Place& source, const Place& target, const Pose& target_from_source) {
  const Eigen::Isometry3f pose = target_from_source.cast<float>();
  double all = 0, near = 0;
  const std::size_t step = step_of(source.view, rough_samples);
  for (std::size_t s = 0; s < source.view.samples.size(); s += step) {
    all += 1;
    near +=
        plane_near(moved(source.view.samples[s], pose), *target.scan, rough_distance) != nullptr;
  }
  return all > 0 ? near / all : 0;
}

/// The evidence of one way.
PoseEvidence one_way(const Place& source, const Place& target, const Pose& target_from_source) {
  const auto touching = static_cast<float>(
      least_touching + touching_per_noise * pair_noise(*source.scan, *target.scan));
  const Eigen::Isometry3f pose = target_from_source.cast<float>();
  double all = 0, near = 0, touch = 0;
  std::vector<std::pair<Eigen::Vector2f, bool>> walls;  // how they face, and whether they touch
  Eigen::Matrix2f facing = Eigen::Matrix2f::Zero();
  const std::size_t step = step_of(source.view, evidence_samples);
  for (std::size_t s = 0; s < source.view.samples.size(); s += step) {
    const RangeView::Sample& sample = source.view.samples[s];
    const RangeView::Sample there = moved(sample, pose);
    const LocalPlane* const plane = plane_near(there, *target.scan, near_surface);
    const bool touches = plane && std::abs(plane->normal.dot(there.point - plane->mean)) < touching;
    all += 1;
    near += plane != nullptr;
    touch += touches;
    if (std::abs(sample.normal.z()) > least_alike) continue;
    walls.emplace_back(sample.normal.head<2>(), touches);
    if (touches) facing += sample.normal.head<2>() * sample.normal.head<2>().transpose();
  }
  const Eigen::Vector2f least_certain =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(facing).eigenvectors().col(0);
  double across = 0, supporting = 0;
  for (const auto& [normal, touches] : walls) {
    if (std::abs(normal.dot(least_certain)) < least_alike) continue;
    across += 1;
    supporting += touches;
  }
  const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0; };
  return {share(touch, all), share(touch, near), share(supporting, across), 0};
}

bool same(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() < same_shift &&
         rotation_angle(a, b) < same_turn;
}

/// Poses from the plans of two scans, ordered by how much of the surfaces then lie near each other.
std::vector<PlanMatch> rough_poses(const Place& source, const Place& target,
                                   const PlanMatchParams& params) {
  std::vector<PlanMatch> matches = matches_of_plans(source.plan, target.plan, params);
  for (PlanMatch& match : matches) {
    const Pose& pose = match.target_from_source;
    match.score = std::min(rough_overlap(source, target, pose),
                           rough_overlap(target, source, pose.inverse()));
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const PlanMatch& a, const PlanMatch& b) { return a.score > b.score; });
  return matches;
}

/// A rough pose after its match.
struct Hypothesis {
  Alignment alignment;
  PoseEvidence evidence;
};

/// Distinct ones, the best first.
std::vector<Hypothesis> hypotheses(const Place& source, const Place& target,
                                   const LocateParams& params) {
  std::vector<PlanMatch> matches = rough_poses(source, target, params.plans);
  if (matches.size() > params.tried_poses) matches.resize(params.tried_poses);
  IcpParams matching = params.matching;
  matching.first_gate = rough_gate;
  matching.last_gate = std::min(matching.last_gate, rough_gate);
  matching.max_points = params.rough_points;
  std::vector<Hypothesis> all;
  for (const PlanMatch& match : matches) {
    const Alignment alignment =
        align(*source.scan, *target.scan, match.target_from_source, matching);
    const Pose& pose = alignment.target_from_source;
    const bool known = std::any_of(all.begin(), all.end(), [&](const Hypothesis& other) {
      return same(other.alignment.target_from_source, pose);
    });
    if (!known) all.push_back({alignment, pose_evidence(source, target, pose)});
  }
  std::stable_sort(all.begin(), all.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.evidence.score() > b.evidence.score();
  });
  return all;
}

std::string doubt(const Hypothesis& best, const LocateParams& params) {
  const PoseEvidence& e = best.evidence;
  if (e.overlap < params.min_overlap)
    return fmt::format("overlap {:.2f} is below {:.2f}", e.overlap, params.min_overlap);
  if (e.contradicted > params.max_contradicted)
    return fmt::format("{:.1f} % of the surfaces were seen through, above {:.1f} %",
                       100 * e.contradicted, 100 * params.max_contradicted);
  if (e.closeness < params.min_closeness)
    return fmt::format("only {:.2f} of near surfaces touch, below {:.2f}", e.closeness,
                       params.min_closeness);
  if (best.alignment.weak_directions > 0)
    return fmt::format("{} directions are not determined", best.alignment.weak_directions);
  if (e.support < params.min_support)
    return fmt::format("support of one direction {:.2f} is below {:.2f}", e.support,
                       params.min_support);
  if (!best.alignment.converged) return "the match did not converge";
  return {};
}

std::string rival(const std::vector<Hypothesis>& all, const LocateParams& params) {
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (all[k].evidence.score() <= params.max_rival * all.front().evidence.score()) break;
    const Pose off =
        all.front().alignment.target_from_source.inverse() * all[k].alignment.target_from_source;
    return fmt::format("another pose {:.2f} m and {:.0f} deg away suits as well",
                       off.translation().norm(), degrees(rotation_angle(off)));
  }
  return {};
}

/// Pairs (lower, higher) of scans that are worth a comparison.
std::vector<std::pair<std::size_t, std::size_t>> similar_pairs(std::span<const Place> places,
                                                               std::size_t similar) {
  std::vector<ScanDescriptor> descriptors;
  for (const Place& place : places) descriptors.push_back(place.descriptor);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  const auto found = similar_scans(descriptors, similar == 0 ? places.size() : similar);
  for (std::size_t a = 0; a < found.size(); ++a)
    for (const SimilarScan& other : found[a]) pairs.insert(std::minmax(a, other.scan));
  return {pairs.begin(), pairs.end()};
}

std::vector<PlaceCandidate> candidates_of(std::span<const Place> places, std::size_t target,
                                          std::size_t source, const PlaceSearchParams& params) {
  std::vector<PlaceCandidate> result;
  std::size_t looked_at = 0;
  PlanMatchParams plans = params.plans;
  plans.max_matches = std::min(plans.max_matches, compared_poses);
  for (const PlanMatch& match : rough_poses(places[source], places[target], plans)) {
    if (match.score < params.least_score || looked_at++ == 2 * params.poses) break;
    const double contradicted =
        check_free_space(places[source].view, places[target].view, match.target_from_source)
            .contradicted();
    const double score = match.score * std::exp(-contradicted / rough_contradiction_scale);
    if (score >= params.least_score)
      result.push_back({target, source, match.target_from_source, score});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  if (result.size() > params.poses) result.resize(params.poses);
  return result;
}

}  // namespace

double PoseEvidence::score() const {
  return overlap * std::exp(-contradicted / contradiction_scale);
}

Place place_of(const MatchingScan& scan) {
  return {&scan, scan_plan(scan), range_view(scan), scan_descriptor(scan)};
}

std::vector<Place> places_of(std::span<const MatchingScan> scans) {
  std::vector<Place> result(scans.size());
  parallel_for(scans.size(), 1,
               [&](std::size_t i, std::size_t) { result[i] = place_of(scans[i]); });
  return result;
}

PoseEvidence pose_evidence(const Place& source, const Place& target,
                           const Pose& target_from_source) {
  const PoseEvidence there = one_way(source, target, target_from_source);
  const PoseEvidence back = one_way(target, source, target_from_source.inverse());
  return {std::min(there.overlap, back.overlap), std::min(there.closeness, back.closeness),
          std::min(there.support, back.support),
          check_free_space(source.view, target.view, target_from_source).contradicted()};
}

std::vector<PlaceCandidate> find_places(std::span<const Place> places,
                                        const PlaceSearchParams& params, const Progress& progress) {
  require(is_share(params.least_score), "least_score", params.least_score, "between 0 and 1");
  const auto pairs = similar_pairs(places, params.similar);
  std::vector<std::vector<PlaceCandidate>> found(pairs.size());
  parallel_for(
      pairs.size(), 1,
      [&](std::size_t k, std::size_t) {
        found[k] = candidates_of(places, pairs[k].first, pairs[k].second, params);
      },
      progress);
  std::vector<PlaceCandidate> result;
  for (const auto& some : found) result.insert(result.end(), some.begin(), some.end());
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  return result;
}

std::vector<PlaceCandidate> find_places(std::span<const MatchingScan> scans,
                                        const PlaceSearchParams& params, const Progress& progress) {
  return find_places(places_of(scans), params, progress);
}

Location locate(const Place& source, const Place& target, const LocateParams& params) {
  check(params);
  const std::vector<Hypothesis> all = hypotheses(source, target, params);
  Location result;
  if (all.empty()) {
    result.reason = "no walls in common";
    return result;
  }
  result.alignment = all.front().alignment;
  result.evidence = all.front().evidence;
  result.reason = doubt(all.front(), params);
  if (result.reason.empty()) result.reason = rival(all, params);
  if (!result.reason.empty()) return result;
  IcpParams matching = params.matching;
  matching.first_gate = last_first_gate;
  matching.last_gate = std::min(matching.last_gate, last_first_gate);
  const Alignment last =
      align(*source.scan, *target.scan, result.alignment.target_from_source, matching);
  if (!last.converged || !same(last.target_from_source, result.alignment.target_from_source)) {
    result.reason = "the match of all points did not converge there";
    return result;
  }
  result.alignment = last;
  result.evidence = pose_evidence(source, target, last.target_from_source);
  result.found = true;
  return result;
}

Location locate(const MatchingScan& source, const MatchingScan& target,
                const LocateParams& params) {
  return locate(place_of(source), place_of(target), params);
}

}  // namespace planum
