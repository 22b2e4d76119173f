#include "slam/registration/matching_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/hash.hpp"
#include "slam/core/parallel.hpp"
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
    hash = mixed(hash);
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

/// Those of `positions` that are among `chosen`, in their order.
std::vector<std::uint32_t> those_among(std::span<const std::uint32_t> chosen,
                                       std::span<const std::uint32_t> positions) {
  std::vector<bool> is_chosen(positions.size(), false);
  for (const std::uint32_t i : chosen) is_chosen[i] = true;
  std::vector<std::uint32_t> result;
  for (const std::uint32_t i : positions)
    if (is_chosen[i]) result.push_back(i);
  return result;
}

/// At most so many of the first, ascending; 0: all.
std::vector<std::uint32_t> first_of(std::span<const std::uint32_t> positions, std::size_t most) {
  if (most > 0) positions = positions.first(std::min(most, positions.size()));
  std::vector<std::uint32_t> result(positions.begin(), positions.end());
  std::sort(result.begin(), result.end());
  return result;
}

/// Count, sum and sum of products of points relative to somewhere near them, as PointMoments but
/// small enough to gather many of them fast.
template <class Real>
struct PatchSums {
  Real count = 0;
  std::array<Real, 3> sum = {};
  std::array<Real, 6> products = {};  // xx xy xz yy yz zz

  /// Adds the points of other sums, all moved by `shift`.
  template <class Other>
  void add(const PatchSums<Other>& other, const std::array<Real, 3>& shift) {
    const Real n = other.count;
    std::array<Real, 3> moved;  // half of what the shift adds to the products
    for (std::size_t i = 0; i < 3; ++i) moved[i] = other.sum[i] + n * shift[i];
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j, ++k)
        products[k] += other.products[k] + other.sum[i] * shift[j] + shift[i] * moved[j];
    for (std::size_t i = 0; i < 3; ++i) sum[i] += moved[i];
    count += n;
  }

  Eigen::Vector3d centroid() const { return Eigen::Vector3d(sum[0], sum[1], sum[2]) / count; }
  Eigen::Matrix3d covariance() const {
    const Eigen::Vector3d mean = centroid();
    const auto& p = products;
    Eigen::Matrix3d squares;
    squares << p[0], p[1], p[2], p[1], p[3], p[4], p[2], p[4], p[5];
    return squares / count - mean * mean.transpose();
  }
};

/// A choice of points, and for each the sums over the points that it stands for, relative to it.
struct Choice {
  std::vector<Eigen::Vector3f> points;
  std::vector<PatchSums<float>> sums;
};

Choice chosen(std::span<const Eigen::Vector3f> points, double voxel) {
  const PatchSums<float> itself{.count = 1};
  Choice result;
  if (voxel == 0) {
    result.points.assign(points.begin(), points.end());
    result.sums.assign(points.size(), itself);
    return result;
  }
  const VoxelGrid grid = voxel_grid(points, voxel);
  result.points.reserve(grid.representative.size());
  for (const std::uint32_t i : grid.representative) result.points.push_back(points[i]);
  result.sums.resize(result.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t v = grid.voxel_of_point[i];
    const Eigen::Vector3f shift = points[i] - result.points[v];
    result.sums[v].add(itself, {shift.x(), shift.y(), shift.z()});
  }
  return result;
}

template <class Value>
std::vector<Value> in_order(const std::vector<Value>& values,
                            std::span<const std::uint32_t> order) {
  std::vector<Value> result;
  result.reserve(order.size());
  for (const std::uint32_t i : order) result.push_back(values[i]);
  return result;
}

/// The plane through neighbours of a point and all that they stand for; empty if they are too few,
/// a line, or no plane at all.
std::optional<LocalPlane> plane_through(std::span<const Neighbour> neighbours,
                                        const Choice& choice) {
  if (neighbours.size() < 4) return std::nullopt;
  const Eigen::Vector3f origin = choice.points[neighbours.front().index];
  PatchSums<double> sums;
  for (const Neighbour& n : neighbours) {
    const Eigen::Vector3f shift = choice.points[n.index] - origin;
    sums.add(choice.sums[n.index], {shift.x(), shift.y(), shift.z()});
  }
  // In closed form: good to a hundredth of a millimetre, and there are many of them.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(sums.covariance());
  const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(0);
  const Eigen::Vector3d deviation = variances.cwiseSqrt();
  if (!(deviation[2] > 0) || deviation[1] < least_width_by_length * deviation[2] ||
      deviation[0] > most_thickness_by_width * deviation[1])
    return std::nullopt;
  const Eigen::Vector3d mean = sums.centroid() + origin.cast<double>();
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  const double side = normal.dot(mean) > 0 ? -1 : 1;
  LocalPlane plane;
  plane.mean = mean.cast<float>();
  plane.normal = (side * normal).cast<float>();
  // Three of the degrees of freedom went into the plane.
  plane.thickness = static_cast<float>(deviation[0] * std::sqrt(sums.count / (sums.count - 3)));
  plane.reach = static_cast<float>(2 * deviation[2]);  // an even disc of radius r deviates by r / 2
  plane.tilt_variance =
      static_cast<float>(plane.thickness * plane.thickness / (sums.count * variances[1]));
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
  return first_of(shuffled, most);
}

std::vector<std::uint32_t> MatchingScan::coarse_selection(std::size_t most) const {
  return first_of(coarse, most);
}

MatchingScan matching_scan(const Cloud& cloud, const MatchingScanParams& params) {
  check(params);
  Choice choice = chosen(cloud.points, params.voxel);
  KdTree tree(choice.points);
  const std::vector<std::uint32_t> order = tree.number_by_leaf();
  choice = {in_order(choice.points, order), in_order(choice.sums, order)};
  MatchingScan scan{.points = choice.points,
                    .planes = std::vector<LocalPlane>(choice.points.size()),
                    .shuffled = shuffled_by_place(choice.points),
                    .coarse = {},
                    .tree = std::move(tree)};
  scan.coarse =
      those_among(voxel_grid(scan.points, params.coarse_voxel).representative, scan.shuffled);
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
                      .shuffled = shuffled_by_place(points),
                      .coarse = {},
                      .tree = KdTree(points)};
  result.coarse = those_among(coarse, result.shuffled);
  if (points.empty()) return result;
  result.noise = upper_median(noise);
  result.spacing = upper_median(spacing);
  result.patch_points = upper_median(patch_points);
  result.radius = rms_range(points);
  return result;
}

}  // namespace planum
