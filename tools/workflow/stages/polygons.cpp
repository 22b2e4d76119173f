#include "meshing/polygons.hpp"

#include <fmt/format.h>

#include "meshing/laser_shadows.hpp"
#include "meshing/regions.hpp"
#include "slam/core/error.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

/// What suits the voxels of the mesh, where the project file does not say otherwise.
RegionParams chosen_region_params(const Settings& settings) {
  RegionParams params = region_params(settings.surface.voxel);
  params.max_angle = settings.polygons.max_angle.value_or(params.max_angle);
  params.max_distance = settings.polygons.max_distance.value_or(params.max_distance);
  params.min_area = settings.polygons.min_area.value_or(params.min_area);
  return params;
}

PolygonParams chosen_polygon_params(const Settings& settings) {
  PolygonParams params = polygon_params(settings.surface.voxel);
  params.max_error = settings.polygons.max_error.value_or(params.max_error);
  return params;
}

std::string summary(const PolygonMap& map) {
  std::size_t holes = 0;
  double area = 0;
  for (const MapPolygon& polygon : map.polygons) {
    holes += polygon.holes.size();
    area += polygon.area;
  }
  return fmt::format(
      "{} polygons with {} holes, {:.1f} m2, {} triangles in no plane, {} shadows filled",
      map.polygons.size(), holes, area, map.rest.triangles.size(), map.inferred.size());
}

void work(StageContext& context) {
  const Settings& settings = context.project.settings;
  const TriangleMesh& mesh = context.results.mesh.get();
  constexpr std::size_t steps = 3;
  context.progress.report(0, steps);
  const Regions regions =
      grow_planes(mesh, context.results.cloud.get(), chosen_region_params(settings));
  context.progress.report(1, steps);
  PolygonMap map = with_shadows_filled(polygonize(mesh, regions, chosen_polygon_params(settings)),
                                       context.results.cloud.get(),
                                       scan_origins(context.results.world.get()), settings.shadows);
  context.progress.report(2, steps);
  if (map.polygons.empty()) {
    throw Error(
        "there is no plane in the mesh; a larger mesh.voxel_m or a smaller "
        "polygons.min_area_m2 may find some",
        ErrorKind::no_result);
  }
  write_result(context.result, map);
  context.record.summary = summary(map);
  context.results.polygons.set(std::move(map));
}

}  // namespace

Stage polygons_stage() {
  return {.name = "polygons",
          .version = 6,
          .unit = "steps",
          .needs = {"cloud", "mesh"},
          .parameters = {"polygons", "mesh.voxel_m"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
