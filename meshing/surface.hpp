#pragma once

#include "slam/core/cloud.hpp"
#include "slam/core/progress.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// How a surface is made from points with normals.
struct SurfaceParams {
  double voxel = 0.05;  ///< m, side of the cells
  double radius = 1.5;  ///< voxels, tangent planes are averaged this far along the surface
  double gap_reach =
      3;  ///< voxels, gaps between scan lines are closed up to twice this width; 0: none
  double min_part = 2;    ///< squares of a voxel, smaller loose parts are specks, not surface
  double sure_part = 40;  ///< squares of a voxel, smaller loose parts have to be seen densely:
  double min_points = 1;  ///< on the square of a voxel
};

/// The surface through the points as triangles: signed distance on a sparse grid, then marching
/// cubes. Its borders are within about a voxel of those of the data.
///
/// Throws Error if the cloud is empty or has no normals, or if a point is not finite; Error of kind
/// no_result if there is no surface in it (no point with a normal, or none with neighbours).
TriangleMesh reconstruct(const Cloud& cloud, const SurfaceParams& params = {},
                         const Progress& progress = {});

}  // namespace planum
