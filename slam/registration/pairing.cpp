#include "slam/registration/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/LU>

#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 1024;

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

/// A point that looks for its pair, in the target's frame.
struct Seeker {
  Eigen::Vector3d point;
  Eigen::Vector3f normal;  ///< zero: unknown
  float tilt_variance;
};

/// The surface of the target around the point that was found.
struct Found {
  Eigen::Vector3f point, smoothed;
  const LocalPlane& plane;
};

std::optional<Pair> planar_pair(const Seeker& seeker, const Found& found, Pairing pairing) {
  if (!found.plane.known()) return std::nullopt;
  Pair pair{.source = seeker.point,
            .target = found.plane.mean.cast<double>(),
            .normal = found.plane.normal.cast<double>(),
            .tilt_variance = found.plane.tilt_variance};
  if (pairing == Pairing::point_to_plane) return pair;
  if (seeker.normal.isZero()) return std::nullopt;
  pair.target = found.smoothed.cast<double>();
  pair.source_normal = seeker.normal.cast<double>();
  pair.tilt_variance = (found.plane.tilt_variance + seeker.tilt_variance) / 4;
  if (pairing == Pairing::symmetric) pair.normal = (pair.normal + pair.source_normal).normalized();
  return pair;
}

double residual_of(const Pair& pair, Pairing pairing) {
  const Eigen::Vector3d offset = pair.source - pair.target;
  if (pairing != Pairing::plane_to_plane) return pair.normal.dot(offset);
  return std::sqrt(std::max(0.0, offset.dot(pair_metric(pair) * offset)));
}

/// Tests the candidate pair of one point; empty if a gate drops it.
std::optional<Pair> tested(const Seeker& seeker, const Found& found, Pairing pairing,
                           const PairGate& gate, float least_cosine) {
  if (found.plane.known() && !seeker.normal.isZero() &&
      seeker.normal.dot(found.plane.normal) < least_cosine)
    return std::nullopt;
  if (pairing == Pairing::point_to_point)
    return Pair{.source = seeker.point,
                .target = found.point.cast<double>(),
                .normal = found.plane.normal.cast<double>(),
                .tilt_variance = found.plane.tilt_variance};
  std::optional<Pair> pair = planar_pair(seeker, found, pairing);
  if (!pair) return std::nullopt;
  pair->weight = biweight(residual_of(*pair, pairing), gate.residual);
  const Eigen::Vector3d offset = seeker.point - found.plane.mean.cast<double>();
  const double across = found.plane.normal.cast<double>().dot(offset);
  const double reach = std::max<double>(found.plane.reach, gate.residual);
  // Beyond its patch a plane says nothing about the surface.
  if (pair->weight == 0 || offset.squaredNorm() - across * across > reach * reach)
    return std::nullopt;
  return pair;
}

}  // namespace

Eigen::Matrix3d pair_metric(const Pair& pair) {
  constexpr double across = 1e-3;  // variance across a plane, where that along it is 1
  const auto covariance = [](const Eigen::Vector3d& normal) -> Eigen::Matrix3d {
    return Eigen::Matrix3d::Identity() - (1 - across) * normal * normal.transpose();
  };
  return 2 * across * (covariance(pair.normal) + covariance(pair.source_normal)).inverse();
}

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
      const Seeker seeker{point, rotation * source_.planes[s].normal,
                          source_.planes[s].tilt_variance};
      const Found found_point{target_.points[nearest->index], target_.smoothed(nearest->index),
                              target_.planes[nearest->index]};
      if (const auto pair = tested(seeker, found_point, pairing, gate, least_cosine))
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
