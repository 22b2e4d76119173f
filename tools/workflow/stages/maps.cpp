#include <fmt/format.h>

#include "labeling/occupancy.hpp"
#include "meshing/triangulation.hpp"
#include "slam/io/pcd.hpp"
#include "tools/maps/floor_plan.hpp"
#include "tools/maps/map_glb.hpp"
#include "tools/maps/map_mesh.hpp"
#include "tools/maps/occupancy_map.hpp"
#include "tools/maps/polygons_json.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

/// A map for each storey; of one storey it is `occupancy.yaml`, of more `occupancy_1.yaml` (the
/// lowest) and so on. Returns how many.
std::size_t write_occupancy(const PolygonMap& map, const Labels& labels, StageContext& context) {
  const std::vector<double> floors = storey_floors(map, labels);
  if (floors.empty())
    context.record.warnings.push_back("no occupancy map: there is no floor for a robot");
  const auto origins = scan_origins(context.results.world.get());
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const std::string name =
        floors.size() == 1 ? "occupancy.yaml" : fmt::format("occupancy_{}.yaml", i + 1);
    write_occupancy_map(
        context.staging / name,
        occupancy_grid(context.results.cloud.get(), origins, context.results.mesh.get(), floors[i],
                       context.project.settings.occupancy));
  }
  return floors.size();
}

void work(StageContext& context) {
  const PolygonMap& map = context.results.polygons.get();
  const Labelled& labelled = context.results.labelled.get();
  const TriangulatedMap mesh = triangulated(map);
  write_polygons_json(context.staging / "polygons.json", {map, labelled.labels, labelled.rooms});
  write_map_ply(context.staging / "map.ply", mesh, labelled.labels);
  write_map_obj(context.staging / "map.obj", mesh, labelled.labels);
  write_map_glb(context.staging / "map.glb", mesh, {map, labelled.labels, labelled.rooms});
  write_pcd(context.staging / "cloud.pcd",
            with_scan_numbers(context.results.cloud.get(), context.results.world.get()));
  if (!labelled.rooms.rooms.empty())
    write_floor_plan_svg(context.staging / "floorplan.svg", labelled.rooms);
  const std::size_t storeys = write_occupancy(map, labelled.labels, context);
  context.record.summary =
      fmt::format("polygons.json, map.ply, map.obj, map.glb, cloud.pcd, {}{} of occupancy",
                  labelled.rooms.rooms.empty() ? "" : "floorplan.svg, ", storeys);
}

}  // namespace

Stage maps_stage() {
  return {.name = "maps",
          .version = 5,
          .unit = "steps",
          .needs = {"cloud", "mesh", "polygons", "labels"},
          .parameters = {"maps"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
