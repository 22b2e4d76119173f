#pragma once

#include <span>

#include "meshing/point_regions.hpp"
#include "meshing/regions.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

struct RefitParams {
  double max_distance = 0.04;      ///< m, farther points do not belong to a plane
  double max_angle = radians(35);  ///< between a plane and the normal of a point; keeps the two
                                   ///< sides of thin walls and the points of edges apart
  std::size_t min_points = 40;     ///< planes with fewer keep what the mesh says
};

/// Planes fitted anew to the points that the mesh was made from: the vertices of a mesh carry the
/// interpolation errors of its cells, points do not. Each point near a triangle of a region counts
/// there if normal and distance agree; Tukey's weights, with a scale from the median residual, keep
/// outliers out (Holland & Welsch 1977). A plane that would leave its triangles by more than
/// max_distance stays as it was. A cloud without normals will do where planes do not meet.
/// Throws Error for a point that is not finite or parameters out of range.
Regions refit_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                     const RefitParams& params = {});

/// A plane near `plane` through points of a cloud (indices, at least three), robustly.
Plane robust_plane(Plane plane, const Cloud& cloud, std::span<const std::uint32_t> points);

/// refit_planes() where it is known which points lie in which region.
Regions refit_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                     const PointRegions& points_in, const RefitParams& params);

}  // namespace planum
