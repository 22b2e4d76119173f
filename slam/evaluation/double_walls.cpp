#include "slam/evaluation/double_walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/robust.hpp"
#include "slam/evaluation/error_statistics.hpp"
#include "slam/evaluation/sampling.hpp"

namespace planum {
namespace {

/// m; what fits better than floats can say needs no more care.
constexpr double rounding = 1e-6;

void check(const DoubleWallParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good) throw Error(fmt::format("evaluation: {} must be {}, got {}", option, limit, value));
  };
  require(params.patch_radius > 0, "patch_radius", params.patch_radius, "> 0 m");
  require(params.max_gap > 0, "max_gap", params.max_gap, "> 0 m");
  require(params.separation > 0, "separation", params.separation, "> 0 m");
  require(params.max_thickness > 0, "max_thickness", params.max_thickness, "> 0 m");
  require(params.max_normal_angle > 0 && params.max_normal_angle < pi / 2, "max_normal_angle",
          degrees(params.max_normal_angle), "between 0 and 90 deg");
  require(params.min_points >= 3, "min_points", params.min_points, ">= 3");
}

/// The points that know which way they face.
Cloud with_normals(const Cloud& cloud) {
  if (cloud.normals.size() != cloud.points.size())
    throw Error(fmt::format("evaluation: {} points have {} normals", cloud.points.size(),
                            cloud.normals.size()));
  Cloud result;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (cloud.normals[i].isZero()) continue;
    result.points.push_back(cloud.points[i]);
    result.normals.push_back(cloud.normals[i]);
  }
  return result;
}

/// m, how far across a surface its points may lie before it is known.
double reach(const DoubleWallParams& params) { return 3 * params.max_thickness; }

/// One point in each cell of the patches' size and for each of six directions it may face, where
/// there are enough to make up a patch with those around.
std::vector<std::size_t> seeds(const Cloud& cloud, const DoubleWallParams& params) {
  using Key = std::array<long, 4>;
  std::vector<std::pair<Key, std::size_t>> keys;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    Eigen::Index facing = 0;
    cloud.normals[i].cwiseAbs().maxCoeff(&facing);
    Key key{};
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      // Flat across the surface, so that one does not hide another behind it.
      const double edge = axis == facing ? reach(params) : params.patch_radius;
      key[static_cast<std::size_t>(axis)] = std::lround(std::floor(cloud.points[i][axis] / edge));
    }
    key[3] = 2 * facing + (cloud.normals[i][facing] < 0 ? 1 : 0);
    keys.emplace_back(key, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> first;
  for (std::size_t begin = 0, end = 1; begin < keys.size(); begin = end++) {
    while (end < keys.size() && keys[end].first == keys[begin].first) ++end;
    if (4 * (end - begin) >= params.min_points) first.push_back(keys[begin].second);
  }
  std::vector<std::size_t> result;
  for (const std::size_t k : evenly_chosen(first.size(), params.max_patches))
    result.push_back(first[k]);
  return result;
}

/// The location that most values agree on: Tukey's biweight from the median.
double robust_mean(std::span<const double> ascending) {
  double mean = quantile(ascending, 0.5);
  std::vector<double> residuals;
  for (int iteration = 0; iteration < 10; ++iteration) {
    residuals.clear();
    for (const double value : ascending) residuals.push_back(std::abs(value - mean));
    const double limit = biweight_limit(residuals);
    if (limit < rounding) return mean;
    double sum = 0, weights = 0;
    for (const double value : ascending) {
      const double weight = biweight(value - mean, limit);
      sum += weight * value;
      weights += weight;
    }
    const double change = sum / weights - mean;
    mean += change;
    if (std::abs(change) < rounding) return mean;
  }
  return mean;
}

/// A group of scans, to be searched.
class Group {
 public:
  Group(const Cloud& cloud, const DoubleWallParams& params)
      : cloud_(cloud),
        tree_(cloud_.points),
        params_(params),
        least_cosine_(std::cos(params.max_normal_angle)) {}

  const Cloud& cloud() const { return cloud_; }

  /// The plane of the surface that a point is on; empty if there are too few points about it, all
  /// in a strip, or too far off it.
  std::optional<PlaneFit> plane_at(std::size_t seed, std::vector<Neighbour>& near) const {
    const Eigen::Vector3f& at = cloud_.points[seed];
    const Eigen::Vector3f& facing = cloud_.normals[seed];
    tree_.within(at, static_cast<float>(params_.patch_radius), near);
    std::vector<Eigen::Vector3d> points;
    for (const Neighbour& n : near) {
      const Eigen::Vector3f offset = cloud_.points[n.index] - at;
      if (cloud_.normals[n.index].dot(facing) < least_cosine_ ||
          std::abs(offset.dot(facing)) > reach(params_))
        continue;
      points.push_back(offset.cast<double>());
    }
    if (points.size() < params_.min_points) return std::nullopt;
    auto fit = robust_plane(points);
    if (!fit) return std::nullopt;
    // Standard deviations of an even disc are half its radius.
    const bool is_wide = fit->variances[1] > std::pow(0.25 * params_.patch_radius, 2);
    const bool is_thin = fit->variances[0] < std::pow(params_.max_thickness, 2);
    if (!is_wide || !is_thin) return std::nullopt;
    const Eigen::Vector3d origin = at.cast<double>();
    fit->plane = planum::facing(fit->plane, facing.cast<double>());
    fit->plane.offset += fit->plane.normal.dot(origin);
    fit->centroid += origin;
    return fit;
  }

  /// m, the surfaces before (+) and behind a patch that face as it does and have enough points,
  /// ascending.
  std::vector<double> surfaces(const PlaneFit& patch, std::size_t least_points,
                               std::vector<Neighbour>& near) const {
    const double radius = std::hypot(params_.patch_radius, params_.max_gap);
    tree_.within(patch.centroid.cast<float>(), static_cast<float>(radius), near);
    const Eigen::Vector3f normal = patch.plane.normal.cast<float>();
    std::vector<double> distances;
    for (const Neighbour& n : near) {
      if (cloud_.normals[n.index].dot(normal) < least_cosine_) continue;
      const Eigen::Vector3d p = cloud_.points[n.index].cast<double>();
      const double distance = patch.plane.signed_distance(p);
      if (std::abs(distance) > params_.max_gap) continue;
      const double aside = (p - patch.centroid - distance * patch.plane.normal).norm();
      if (aside <= params_.patch_radius) distances.push_back(distance);
    }
    std::sort(distances.begin(), distances.end());
    std::vector<double> result;
    for (std::size_t begin = 0, end = 1; begin < distances.size(); begin = end++) {
      while (end < distances.size() && distances[end] - distances[end - 1] <= params_.separation)
        ++end;
      if (end - begin >= least_points)
        result.push_back(robust_mean(std::span(distances).subspan(begin, end - begin)));
    }
    return result;
  }

 private:
  /// Total least squares, weighted by the biweight of the distances.
  static std::optional<PlaneFit> robust_plane(const std::vector<Eigen::Vector3d>& points) {
    auto fit = fit_plane(points);
    std::vector<double> distances;
    for (int iteration = 0; fit && iteration < 3; ++iteration) {
      distances.clear();
      for (const auto& p : points) distances.push_back(std::abs(fit->plane.signed_distance(p)));
      const double limit = biweight_limit(distances);
      if (limit < rounding) break;
      PointMoments moments;
      for (const auto& p : points) moments.add(p, biweight(fit->plane.signed_distance(p), limit));
      fit = fit_plane(moments);
    }
    return fit;
  }

  Cloud cloud_;
  KdTree tree_;
  const DoubleWallParams& params_;
  float least_cosine_;
};

/// Of ascending values the one nearest to `value`, if there is one.
std::optional<double> nearest_to(double value, const std::vector<double>& values) {
  const auto nearest = std::min_element(values.begin(), values.end(), [&](double a, double b) {
    return std::abs(a - value) < std::abs(b - value);
  });
  if (nearest == values.end()) return std::nullopt;
  return *nearest;
}

std::optional<DoubleWallPatch> compared(const Group& first, const Group& second, std::size_t seed,
                                        std::size_t min_points) {
  std::vector<Neighbour> near;
  const auto patch = first.plane_at(seed, near);
  if (!patch) return std::nullopt;
  const auto gap = nearest_to(0, second.surfaces(*patch, min_points, near));
  if (!gap) return std::nullopt;
  // The other way round it must be the same pair of surfaces; against it, few points say enough.
  const std::vector<double> own = first.surfaces(*patch, (min_points + 2) / 3, near);
  if (nearest_to(*gap, own) != nearest_to(0, own)) return std::nullopt;
  return DoubleWallPatch{patch->centroid, patch->plane.normal, *gap};
}

}  // namespace

std::vector<DoubleWallPatch> double_walls(const Cloud& first, const Cloud& second,
                                          const DoubleWallParams& params) {
  check(params);
  const Group a(with_normals(first), params), b(with_normals(second), params);
  const std::vector<std::size_t> places = seeds(a.cloud(), params);
  std::vector<std::optional<DoubleWallPatch>> of_place(places.size());
  parallel_for(places.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      of_place[k] = compared(a, b, places[k], params.min_points);
  });
  std::vector<DoubleWallPatch> result;
  for (const auto& patch : of_place)
    if (patch) result.push_back(*patch);
  return result;
}

DoubleWallGap double_wall_gap(std::span<const DoubleWallPatch> patches) {
  std::vector<double> gaps;
  for (const DoubleWallPatch& patch : patches) gaps.push_back(std::abs(patch.gap));
  std::sort(gaps.begin(), gaps.end());
  const ErrorStatistics s = statistics(gaps);
  return {.patches = s.count,
          .median = s.median,
          .mean = s.mean,
          .percentile_90 = quantile(gaps, 0.9),
          .max = s.max};
}

}  // namespace planum
