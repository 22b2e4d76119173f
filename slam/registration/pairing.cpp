#include "slam/registration/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 1024;

/// How much a pair counts: 1 on the plane, falling smoothly to 0 at the gate (Tukey's biweight).
double biweight(double residual, double gate) {
  const double ratio = residual / gate;
  const double rest = 1 - ratio * ratio;
  return rest > 0 ? rest * rest : 0;
}

/// A number that looks random but depends on nothing but the place, to 5 cm.
std::uint64_t rank_of_place(const Eigen::Vector3f& point) {
  std::uint64_t hash = 0x9E3779B97F4A7C15u;
  for (const float coordinate : point) {
    hash ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate * 20)));
    // The finalizer of splitmix64 (Steele, Lea, Flood: OOPSLA 2014).
    hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
    hash ^= hash >> 31;
  }
  return hash;
}

/// Tests the candidate pair of one point; empty if a gate drops it.
std::optional<Pair> tested(const Eigen::Vector3d& point, const Eigen::Vector3f& normal,
                           const Eigen::Vector3f& nearest, const LocalPlane& plane, Pairing pairing,
                           const PairGate& gate, float least_cosine) {
  if (plane.known() && !normal.isZero() && normal.dot(plane.normal) < least_cosine)
    return std::nullopt;
  Pair pair{.source = point,
            .target = nearest.cast<double>(),
            .normal = plane.normal.cast<double>(),
            .tilt_variance = plane.tilt_variance};
  if (pairing == Pairing::point_to_point) return pair;
  if (!plane.known()) return std::nullopt;
  pair.target = plane.mean.cast<double>();
  const Eigen::Vector3d offset = point - pair.target;
  const double residual = pair.normal.dot(offset);
  const double along_squared = offset.squaredNorm() - residual * residual;
  const double reach = std::max<double>(plane.reach, gate.residual);
  pair.weight = biweight(residual, gate.residual);
  // Beyond its patch a plane says nothing about the surface.
  if (pair.weight == 0 || along_squared > reach * reach) return std::nullopt;
  return pair;
}

}  // namespace

PairFinder::PairFinder(const MatchingScan& source, const MatchingScan& target,
                       std::vector<std::uint32_t> selection)
    : source_(source),
      target_(target),
      selection_(std::move(selection)),
      leaf_hints_(selection_.size(), 0) {}

std::vector<Pair> PairFinder::find(const Pose& target_from_source, Pairing pairing,
                                   const PairGate& gate) {
  const std::size_t blocks = (selection_.size() + points_per_block - 1) / points_per_block;
  std::vector<std::vector<Pair>> found(blocks);
  const float least_cosine = static_cast<float>(std::cos(gate.max_normal_angle));
  const Eigen::Matrix3f rotation = target_from_source.linear().cast<float>();
  parallel_for(selection_.size(), points_per_block, [&](std::size_t begin, std::size_t end) {
    std::vector<Pair>& pairs = found[begin / points_per_block];
    pairs.reserve(end - begin);
    std::uint32_t last_leaf = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t s = selection_[i];
      const Eigen::Vector3f from =
          pairing == Pairing::point_to_point ? source_.points[s] : source_.smoothed(s);
      const Eigen::Vector3d point = target_from_source * from.cast<double>();
      // A new point starts where the one before it, most likely its neighbour, ended.
      std::uint32_t& hint = leaf_hints_[i];
      if (hint == 0) hint = last_leaf;
      const std::optional<Neighbour> nearest =
          target_.tree.nearest(point.cast<float>(), static_cast<float>(gate.distance), hint);
      last_leaf = hint;
      if (!nearest) continue;
      const Eigen::Vector3f normal = rotation * source_.planes[s].normal;
      if (const std::optional<Pair> pair =
              tested(point, normal, target_.points[nearest->index], target_.planes[nearest->index],
                     pairing, gate, least_cosine))
        pairs.push_back(*pair);
    }
  });
  std::vector<Pair> result;
  result.reserve(selection_.size());
  for (const std::vector<Pair>& pairs : found)
    result.insert(result.end(), pairs.begin(), pairs.end());
  return result;
}

double PairFinder::redundancy(Pairing pairing) const {
  if (pairing == Pairing::point_to_point || source_.points.empty()) return 1;
  const double share =
      static_cast<double>(selection_.size()) / static_cast<double>(source_.points.size());
  return std::max(1.0, share * source_.patch_points);
}

std::vector<std::uint32_t> stable_selection(std::span<const Eigen::Vector3f> points,
                                            std::size_t most) {
  std::vector<std::uint32_t> selection(points.size());
  std::iota(selection.begin(), selection.end(), 0u);
  if (points.size() <= most) return selection;
  std::vector<std::uint64_t> rank(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) rank[i] = rank_of_place(points[i]);
  const auto end = selection.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(selection.begin(), end, selection.end(), [&](std::uint32_t a, std::uint32_t b) {
    return rank[a] != rank[b] ? rank[a] < rank[b] : a < b;
  });
  selection.erase(end, selection.end());
  std::sort(selection.begin(), selection.end());
  return selection;
}

}  // namespace planum
