#pragma once

#include "meshing/point_regions.hpp"
#include "meshing/regions.hpp"

namespace planum {

/// Adds planes that the points show and the mesh does not: a mesh of cells rounds what is only a
/// few cells wide, so that no triangle of it is flat. Surfels of the points in no region grow to
/// planes, as triangles do, and take the triangles of the rest that lie near them. Regions come
/// back sorted by area, the largest first. A cloud without normals adds nothing.
Regions with_small_planes(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                          const PointRegions& points_in, const RegionParams& params);

}  // namespace planum
