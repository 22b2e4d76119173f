#include "slam/registration/matching_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/robust.hpp"
#include "slam/registration/reduction.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 512;
/// A patch counts as a plane if it is this much thinner than wide, and is no line.
constexpr double most_thickness_by_width = 1.0 / 3;
constexpr double least_width_by_length = 1.0 / 5;

void check(const MatchingScanParams& params) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good)
      throw Error(fmt::format("registration: {} must be {}, got {}", option, limit, value));
  };
  require(params.voxel >= 0 && std::isfinite(params.voxel), "voxel", params.voxel, ">= 0 m");
  require(params.coarse_voxel > 0 && std::isfinite(params.coarse_voxel), "coarse_voxel",
          params.coarse_voxel, "> 0 m");
  require(params.neighbours >= 4, "neighbours", params.neighbours, ">= 4");
  require(params.most_neighbours >= params.neighbours, "most_neighbours", params.most_neighbours,
          ">= neighbours");
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

std::vector<std::uint32_t> shuffled_by_place(std::span<const Eigen::Vector3f> points) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> ranked(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    ranked[i] = {rank_of_place(points[i]), static_cast<std::uint32_t>(i)};
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::uint32_t> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result[i] = ranked[i].second;
  return result;
}

/// A choice of points, and for each the sums over the points that it stands for, relative to it.
struct Choice {
  std::vector<Eigen::Vector3f> points;
  std::vector<PointMoments> moments;
};

Choice choice_of(std::span<const Eigen::Vector3f> points, double voxel) {
  Choice result;
  if (voxel == 0) {
    result.points.assign(points.begin(), points.end());
    result.moments.resize(points.size());
    for (PointMoments& m : result.moments) m.add(Eigen::Vector3d::Zero());
    return result;
  }
  const VoxelGrid grid = voxel_grid(points, voxel);
  result.points.reserve(grid.representative.size());
  for (const std::uint32_t i : grid.representative) result.points.push_back(points[i]);
  result.moments.resize(result.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t v = grid.voxel_of_point[i];
    result.moments[v].add((points[i] - result.points[v]).cast<double>());
  }
  return result;
}

/// The sums of `moments` over points that are all moved by `shift`.
PointMoments moved(const PointMoments& moments, const Eigen::Vector3d& shift) {
  PointMoments result = moments;
  const Eigen::Matrix3d mixed = moments.sum * shift.transpose();
  result.squares += mixed + mixed.transpose() + moments.count * shift * shift.transpose();
  result.sum += moments.count * shift;
  return result;
}

/// The plane through neighbours of a point and all that they stand for; empty if they are too few,
/// a line, or no plane at all.
std::optional<LocalPlane> plane_through(std::span<const Neighbour> neighbours,
                                        const Choice& choice) {
  if (neighbours.size() < 4) return std::nullopt;
  const Eigen::Vector3f origin = choice.points[neighbours.front().index];
  PointMoments moments;
  for (const Neighbour& n : neighbours)
    moments += moved(choice.moments[n.index], (choice.points[n.index] - origin).cast<double>());
  const std::optional<PlaneFit> fit = fit_plane(moments);
  if (!fit) return std::nullopt;
  const Eigen::Vector3d deviation = fit->variances.cwiseSqrt();
  if (deviation[1] < least_width_by_length * deviation[2] ||
      deviation[0] > most_thickness_by_width * deviation[1])
    return std::nullopt;
  const Eigen::Vector3d mean = fit->centroid + origin.cast<double>();
  const double side = fit->plane.normal.dot(mean) > 0 ? -1 : 1;
  LocalPlane plane;
  plane.mean = mean.cast<float>();
  plane.normal = (side * fit->plane.normal).cast<float>();
  // Three of the degrees of freedom went into the plane.
  plane.thickness =
      static_cast<float>(deviation[0] * std::sqrt(moments.count / (moments.count - 3)));
  plane.reach = static_cast<float>(2 * deviation[2]);  // an even disc of radius r deviates by r / 2
  plane.tilt_variance =
      static_cast<float>(plane.thickness * plane.thickness / (moments.count * fit->variances[1]));
  return plane;
}

double median(std::vector<float> values) { return values.empty() ? 0 : upper_median(values); }

/// m, rms distance from the origin.
double rms_range(std::span<const Eigen::Vector3f> points) {
  if (points.empty()) return 0;
  double squares = 0;
  for (const Eigen::Vector3f& p : points) squares += p.squaredNorm();
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// Fits the planes of points [begin, end) and notes the distances to the next points.
void fit_planes(const Choice& choice, const MatchingScanParams& params, std::size_t begin,
                std::size_t end, MatchingScan& scan, std::vector<float>& spacing) {
  std::vector<Neighbour> neighbours;
  for (std::size_t i = begin; i < end; ++i) {
    scan.tree.k_nearest(scan.points[i], params.neighbours, neighbours);
    std::optional<LocalPlane> plane = plane_through(neighbours, choice);
    if (!plane) {
      scan.tree.k_nearest(scan.points[i], params.most_neighbours, neighbours);
      for (std::size_t k = 2 * params.neighbours; !plane && k <= neighbours.size(); k *= 2)
        plane = plane_through(std::span(neighbours).first(k), choice);
    }
    scan.planes[i] = plane.value_or(LocalPlane{.mean = scan.points[i]});
    spacing[i] = neighbours.size() > 1 ? std::sqrt(neighbours[1].squared_distance) : 0;
  }
}

}  // namespace

std::vector<std::uint32_t> MatchingScan::selection(std::size_t most) const {
  std::vector<std::uint32_t> result;
  if (most == 0 || most >= points.size()) {
    result.resize(points.size());
    std::iota(result.begin(), result.end(), 0u);
    return result;
  }
  result.assign(shuffled.begin(), shuffled.begin() + static_cast<std::ptrdiff_t>(most));
  std::sort(result.begin(), result.end());
  return result;
}

MatchingScan matching_scan(const Cloud& cloud, const MatchingScanParams& params) {
  check(params);
  const Choice choice = choice_of(cloud.points, params.voxel);
  MatchingScan scan{.points = choice.points,
                    .planes = std::vector<LocalPlane>(choice.points.size()),
                    .coarse = voxel_grid(choice.points, params.coarse_voxel).representative,
                    .shuffled = shuffled_by_place(choice.points),
                    .tree = KdTree(choice.points)};
  std::vector<float> spacing(scan.points.size());
  parallel_for(scan.points.size(), points_per_block, [&](std::size_t begin, std::size_t end) {
    fit_planes(choice, params, begin, end, scan, spacing);
  });
  std::vector<float> thickness;
  for (const LocalPlane& plane : scan.planes)
    if (plane.known()) thickness.push_back(plane.thickness);
  scan.noise = median(std::move(thickness));
  scan.spacing = median(std::move(spacing));
  scan.radius = rms_range(scan.points);
  scan.patch_points = static_cast<double>(params.neighbours);
  return scan;
}

MatchingScan merged(std::span<const PlacedScan> scans) {
  std::vector<Eigen::Vector3f> points;
  std::vector<LocalPlane> planes;
  std::vector<std::uint32_t> coarse;
  std::vector<double> noise, spacing, patch_points;
  for (const auto& [scan, frame_from_scan] : scans) {
    if (scan->points.empty()) continue;
    const auto first = static_cast<std::uint32_t>(points.size());
    const Eigen::Matrix3f turn = frame_from_scan.linear().cast<float>();
    for (std::size_t i = 0; i < scan->points.size(); ++i) {
      points.push_back((frame_from_scan * scan->points[i].cast<double>()).cast<float>());
      LocalPlane plane = scan->planes[i];
      plane.mean = (frame_from_scan * plane.mean.cast<double>()).cast<float>();
      plane.normal = turn * plane.normal;
      planes.push_back(plane);
    }
    for (const std::uint32_t i : scan->coarse) coarse.push_back(first + i);
    noise.push_back(scan->noise);
    spacing.push_back(scan->spacing);
    patch_points.push_back(scan->patch_points);
  }
  MatchingScan result{.points = points,
                      .planes = std::move(planes),
                      .coarse = std::move(coarse),
                      .shuffled = shuffled_by_place(points),
                      .tree = KdTree(points)};
  if (points.empty()) return result;
  result.noise = upper_median(noise);
  result.spacing = upper_median(spacing);
  result.patch_points = upper_median(patch_points);
  result.radius = rms_range(points);
  return result;
}

}  // namespace planum
