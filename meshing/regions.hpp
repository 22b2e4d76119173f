#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Triangles of a mesh that lie in one plane.
struct Region {
  Plane plane;      ///< normal into free space
  double area = 0;  ///< m^2, of its triangles
};

/// A mesh divided into planar regions, the largest first, and a rest.
struct Regions {
  static constexpr std::uint32_t rest = std::numeric_limits<std::uint32_t>::max();

  std::vector<Region> regions;
  std::vector<std::uint32_t> of_triangle;  ///< for each triangle its region, or `rest`
};

struct RegionParams {
  double max_angle = radians(25);  ///< between a plane and the (smoothed) normal of a triangle
  double max_distance = 0.03;      ///< m, of a triangle from its plane
  double min_area = 0.04;          ///< m^2, smaller planes stay triangles; 0: keep all
  double max_seed_spread =
      radians(12);                  ///< rms of the normals around a triangle where a plane begins
  double min_radius = 0.5;          ///< m, what is bent more tightly is no plane; 0: no limit
  double merge_angle = radians(6);  ///< neighbours whose normals differ less may be one plane
  double merge_distance = 0.012;    ///< m rms, ... if both are this near to the common plane
};

/// Parameters that suit a mesh with cells of this size (m), e.g. of marching cubes.
RegionParams region_params(double cell);

/// Region growing (Wiemann et al. 2010, Algorithm 1) without recursion. Planes begin where the mesh
/// is flattest and grow over triangles that agree with the running plane in normal and distance;
/// the plane is fitted anew as it grows. Neighbours that are one plane are merged. The result does
/// not depend on the number of threads. Throws Error for parameters out of range and for a mesh
/// with indices or coordinates that are none.
Regions grow_planes(const TriangleMesh& mesh, const RegionParams& params = {});

/// The same with the points that the mesh was made from, and their normals: planes are fitted to
/// the points (refit_planes()), and planes that the mesh shows only as a rounded edge, such as the
/// jambs of a door, are found in the points that lie in no plane of the mesh (small_planes.hpp).
Regions grow_planes(const TriangleMesh& mesh, const Cloud& cloud, const RegionParams& params = {});

}  // namespace planum
