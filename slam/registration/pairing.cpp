#include "slam/registration/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 1024;

/// A point that looks for its pair, in the target's frame.
struct Moved {
  Eigen::Vector3d point;
  Eigen::Vector3f normal;  ///< zero: unknown
  float tilt_variance;
};

/// The surface of the target around the point that was found.
struct Found {
  const Eigen::Vector3f& point;
  const LocalPlane& plane;

  Eigen::Vector3f smoothed() const {
    return point - plane.normal.dot(point - plane.mean) * plane.normal;
  }
};

std::optional<Pair> planar_pair(const Moved& seeker, const Found& found, Pairing pairing) {
  if (!found.plane.known()) return std::nullopt;
  Pair pair{.source = seeker.point,
            .target = found.plane.mean.cast<double>(),
            .normal = found.plane.normal.cast<double>(),
            .tilt_variance = found.plane.tilt_variance};
  if (pairing == Pairing::point_to_plane) return pair;
  if (seeker.normal.isZero()) return std::nullopt;
  pair.target = found.smoothed().cast<double>();
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
std::optional<Pair> tested(const Moved& seeker, const Found& found, Pairing pairing,
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
                       std::span<const std::uint32_t> selection)
    : source_(&source), target_(&target) {
  select(selection);
}

void PairFinder::select(std::span<const std::uint32_t> selection) {
  const std::vector<Seeker> before = std::exchange(seekers_, {});
  seekers_.reserve(selection.size());
  auto old = before.begin();
  for (const std::uint32_t s : selection) {
    while (old != before.end() && old->index < s) ++old;
    const bool stays = old != before.end() && old->index == s;
    seekers_.push_back({.index = s,
                        .point = source_->points[s],
                        .smoothed = source_->smoothed(s),
                        .normal = source_->planes[s].normal,
                        .tilt_variance = source_->planes[s].tilt_variance,
                        .memory = stays ? old->memory : SearchMemory{}});
  }
}

std::vector<Pair> PairFinder::find(const Pose& target_from_source, Pairing pairing,
                                   const PairGate& gate) {
  const std::size_t blocks = (seekers_.size() + points_per_block - 1) / points_per_block;
  std::vector<std::vector<Pair>> found(blocks);
  const float least_cosine = static_cast<float>(std::cos(gate.max_normal_angle));
  const Eigen::Matrix3f rotation = target_from_source.linear().cast<float>();
  parallel_for(seekers_.size(), points_per_block, [&](std::size_t begin, std::size_t end) {
    std::vector<Pair>& pairs = found[begin / points_per_block];
    pairs.reserve(end - begin);
    std::uint32_t last_place = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Seeker& seeker = seekers_[i];
      const Eigen::Vector3f& from =
          pairing == Pairing::point_to_point ? seeker.point : seeker.smoothed;
      const Eigen::Vector3d point = target_from_source * from.cast<double>();
      // A new point starts where the one before it, most likely its neighbour, ended.
      if (seeker.memory.place == 0) seeker.memory.place = last_place;
      const std::optional<Neighbour> nearest = target_->tree.nearest(
          point.cast<float>(), static_cast<float>(gate.distance), seeker.memory);
      last_place = seeker.memory.place;
      if (!nearest) continue;
      const Moved moved{point, rotation * seeker.normal, seeker.tilt_variance};
      const Found found_point{target_->points[nearest->index], target_->planes[nearest->index]};
      if (const auto pair = tested(moved, found_point, pairing, gate, least_cosine))
        pairs.push_back(*pair);
    }
  });
  std::vector<Pair> result;
  result.reserve(seekers_.size());
  for (const std::vector<Pair>& pairs : found)
    result.insert(result.end(), pairs.begin(), pairs.end());
  return result;
}

double PairFinder::redundancy(Pairing pairing) const {
  if (pairing == Pairing::point_to_point || source_->points.empty()) return 1;
  const double share =
      static_cast<double>(seekers_.size()) / static_cast<double>(source_->points.size());
  return std::max(1.0, share * source_->patch_points);
}

}  // namespace planum
