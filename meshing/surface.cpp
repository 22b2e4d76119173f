#include "meshing/surface.hpp"

#include "meshing/distance_field.hpp"
#include "meshing/loose_parts.hpp"
#include "meshing/marching_cubes.hpp"
#include "slam/core/error.hpp"

namespace planum {

TriangleMesh reconstruct(const Cloud& cloud, const SurfaceParams& params,
                         const Progress& progress) {
  const double square = params.voxel * params.voxel;
  TriangleMesh mesh =
      without_loose_parts(marching_cubes(distance_field(cloud, params, progress)), cloud,
                          {.min_area = params.min_part * square,
                           .sure_area = params.sure_part * square,
                           .min_density = params.min_points / square,
                           .cell = params.voxel});
  if (mesh.triangles.empty())
    throw Error("mesh: no surface in the cloud: its points are too far apart for cells of " +
                    std::to_string(params.voxel) + " m",
                ErrorKind::no_result);
  return mesh;
}

}  // namespace planum
