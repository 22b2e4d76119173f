#include "meshing/triangulation.hpp"
#include "tools/maps/map_mesh.hpp"
#include "tools/maps/polygons_json.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

void work(StageContext& context) {
  const PolygonMap& map = context.results.polygons.get();
  const Labelled& labelled = context.results.labelled.get();
  const TriangulatedMap mesh = triangulated(map);
  write_polygons_json(context.staging / "polygons.json", {map, labelled.labels, labelled.rooms});
  write_map_ply(context.staging / "map.ply", mesh, labelled.labels);
  write_map_obj(context.staging / "map.obj", mesh, labelled.labels);
  context.record.summary = "polygons.json, map.ply, map.obj";
}

}  // namespace

Stage maps_stage() {
  return {.name = "maps",
          .version = 1,
          .unit = "steps",
          .needs = {"polygons", "labels"},
          .parameters = {"maps"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
