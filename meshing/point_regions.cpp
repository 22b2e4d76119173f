#include "meshing/point_regions.hpp"

#include <cmath>
#include <string>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

void check(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud) {
  if (regions.of_triangle.size() != mesh.triangles.size())
    throw Error("regions: they are of a mesh of " + std::to_string(regions.of_triangle.size()) +
                " triangles, this one has " + std::to_string(mesh.triangles.size()));
  if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size())
    throw Error("regions: the cloud has " + std::to_string(cloud.points.size()) + " points and " +
                std::to_string(cloud.normals.size()) + " normals");
}

}  // namespace

PointRegions point_regions(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                           double max_distance, double max_angle) {
  check(regions, mesh, cloud);
  PointRegions result{std::vector<std::uint32_t>(cloud.points.size(), PointRegions::none),
                      RegionLookup(regions, mesh, max_distance)};
  const double min_cosine = std::cos(max_angle);
  const auto agrees = [&](std::size_t i, std::uint32_t region) {
    const Plane& plane = regions.regions[region].plane;
    if (std::abs(plane.signed_distance(cloud.points[i].cast<double>())) > max_distance)
      return false;
    return cloud.normals.empty() || cloud.normals[i].cast<double>().dot(plane.normal) >= min_cosine;
  };
  parallel_for(cloud.points.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!cloud.points[i].allFinite())
        throw Error("cloud: point " + std::to_string(i) + " is not finite");
      const RegionLookup::Candidates* candidates = result.lookup.near(cloud.points[i]);
      if (!candidates) continue;
      std::uint32_t& region_of = result.of_point[i];
      for (const std::uint32_t region : *candidates)
        if (region != Regions::rest && agrees(i, region))
          region_of = region_of == PointRegions::none ? region : PointRegions::several;
    }
  });
  return result;
}

}  // namespace planum
