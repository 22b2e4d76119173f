#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/workflow/map_steps.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

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
  PolygonMap map = polygon_map(context.results.mesh.get(), context.results.cloud.get(),
                               scan_origins(context.results.world.get()), context.project.settings,
                               context.progress);
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
