#include "meshing/plane_refit.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/robust.hpp"

namespace planum {
namespace {

constexpr std::size_t max_points = 60'000;  ///< a region; more make no plane better
constexpr int iterations = 4;

/// The points of each region, in their order, at most max_points evenly picked.
std::vector<std::vector<std::uint32_t>> points_of_regions(
    const std::vector<std::uint32_t>& region_of, std::size_t regions) {
  std::vector<std::size_t> count(regions, 0), seen(regions, 0);
  for (const std::uint32_t region : region_of)
    if (region < regions) ++count[region];
  std::vector<std::vector<std::uint32_t>> points(regions);
  for (std::uint32_t i = 0; i < region_of.size(); ++i) {
    const std::uint32_t region = region_of[i];
    if (region >= regions) continue;
    const std::size_t step = (count[region] + max_points - 1) / max_points;
    if (seen[region]++ % step == 0) points[region].push_back(i);
  }
  return points;
}

/// For each region, how far its vertices are from a plane at most (m).
std::vector<double> largest_distances(const Regions& regions, const TriangleMesh& mesh,
                                      const std::vector<Plane>& planes) {
  std::vector<double> largest(planes.size(), 0);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::uint32_t region = regions.of_triangle[f];
    if (region == Regions::rest) continue;
    for (const std::uint32_t v : mesh.triangles[f])
      largest[region] =
          std::max(largest[region],
                   std::abs(planes[region].signed_distance(mesh.vertices[v].cast<double>())));
  }
  return largest;
}

}  // namespace

Plane robust_plane(Plane plane, const Cloud& cloud, std::span<const std::uint32_t> points) {
  const Eigen::Vector3d origin = cloud.points[points.front()].cast<double>();
  plane.offset -= plane.normal.dot(origin);
  std::vector<double> residuals(points.size());
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const auto at = [&](std::size_t i) -> Eigen::Vector3d {
      return cloud.points[points[i]].cast<double>() - origin;
    };
    for (std::size_t i = 0; i < points.size(); ++i)
      residuals[i] = std::abs(plane.signed_distance(at(i)));
    const double limit = std::max(biweight_limit(residuals), 1e-6);
    PointMoments moments;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d p = at(i);
      const double weight = biweight(plane.signed_distance(p), limit);
      if (weight > 0) moments.add(p, weight);
    }
    const std::optional<PlaneFit> fit = fit_plane(moments);
    if (!fit) break;
    plane = facing(fit->plane, plane.normal);
  }
  plane.offset += plane.normal.dot(origin);
  return plane;
}

Regions refit_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                     const PointRegions& points_in, const RefitParams& params) {
  const auto points = points_of_regions(points_in.of_point, regions.regions.size());
  std::vector<Plane> before, after;
  for (const Region& region : regions.regions) before.push_back(region.plane);
  after = before;
  parallel_for(points.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r)
      if (points[r].size() >= std::max<std::size_t>(params.min_points, 3))
        after[r] = robust_plane(before[r], cloud, points[r]);
  });
  const std::vector<double> was = largest_distances(regions, mesh, before);
  const std::vector<double> is = largest_distances(regions, mesh, after);
  Regions result = regions;
  for (std::size_t r = 0; r < after.size(); ++r)
    if (is[r] <= was[r] + params.max_distance) result.regions[r].plane = after[r];
  return result;
}

Regions refit_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                     const RefitParams& params) {
  if (!(params.max_distance > 0))
    throw Error("regions: max_distance of the refit is " + std::to_string(params.max_distance) +
                ", must be above 0");
  return refit_planes(regions, mesh, cloud,
                      point_regions(regions, mesh, cloud, params.max_distance, params.max_angle),
                      params);
}

}  // namespace planum
