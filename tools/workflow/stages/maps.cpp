#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "labeling/keepout.hpp"
#include "labeling/occupancy.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/io/pcd.hpp"
#include "tools/maps/city_json.hpp"
#include "tools/maps/floor_plan_dxf.hpp"
#include "tools/maps/floor_plan_svg.hpp"
#include "tools/maps/map_glb.hpp"
#include "tools/maps/map_mesh.hpp"
#include "tools/maps/navmesh.hpp"
#include "tools/maps/objects_obj.hpp"
#include "tools/maps/occupancy_map.hpp"
#include "tools/maps/octomap_map.hpp"
#include "tools/maps/polygons_json.hpp"
#include "tools/maps/sdf_world.hpp"
#include "tools/maps/texture_frames.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/stages/stages.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

/// One format: its (first) file, whether it is wanted, and who writes it.
struct Exporter {
  std::string file;
  bool is_wanted = true;
  std::function<void(const fs::path& file)> write;
};

/// A map for each storey, and its keep-out mask; of one storey they are `occupancy.yaml` and
/// `keepout.yaml`, of more `occupancy_1.yaml` (the lowest) and so on.
void write_occupancy(const fs::path& path, StageContext& context) {
  Results& results = context.results;
  const PolygonMap& map = results.polygons.get();
  const Labels& labels = results.labelled.get().labels;
  const OccupancyParams& params = context.project.settings.occupancy;
  const std::vector<double> floors = storey_floors(map, labels);
  if (floors.empty()) throw Error(path.string() + ": there is no floor for a robot");
  const auto origins = scan_origins(results.world.get());
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const std::string ending = floors.size() == 1 ? ".yaml" : fmt::format("_{}.yaml", i + 1);
    const OccupancyGrid storey =
        occupancy_grid(results.cloud.get(), origins, results.mesh.get(), floors[i], params);
    write_occupancy_map(path.parent_path() / ("occupancy" + ending), storey);
    write_occupancy_map(path.parent_path() / ("keepout" + ending),
                        keepout_mask(map, labels, storey, {.max_step = params.low}));
  }
}

/// A plan for each storey that has a room; of one storey it is `path`, of more floorplan_1 (the
/// lowest) and so on.
void write_floor_plans(const fs::path& path, const RoomMap& rooms,
                       void (*write)(const fs::path&, const PlanDrawing&)) {
  std::set<std::size_t> storeys;
  for (const Room& room : rooms.rooms) storeys.insert(room.storey);
  for (const std::size_t storey : storeys) {
    const std::string name =
        fmt::format("{}_{}{}", path.stem().string(), storey + 1, path.extension().string());
    write(rooms.storeys.size() > 1 ? path.parent_path() / name : path, plan_drawing(rooms, storey));
  }
}

/// An error of `exporter` as a warning: what is wrong with the map is no reason to have no other.
std::string warning_of(const Exporter& exporter, const Error& error, const fs::path& staging) {
  const std::string text = error.what(), start = (staging / exporter.file).string() + ": ";
  return fmt::format("no {}: {}", exporter.file,
                     text.starts_with(start) ? text.substr(start.size()) : text);
}

void work(StageContext& context) {
  Results& results = context.results;
  const Settings& settings = context.project.settings;
  const MapSettings& wanted = settings.maps;
  const PolygonMap& map = results.polygons.get();
  const Labelled& labelled = results.labelled.get();
  const LabelledMap labelled_map{map, labelled.labels, labelled.rooms, labelled.objects};
  const TriangulatedMap mesh = triangulated(map);
  const std::vector<TextureFrame> frames =
      wanted.textures ? texture_frames(map, labelled.labels) : std::vector<TextureFrame>();

  write_polygons_json(context.staging / "polygons.json", labelled_map);
  write_map_ply(context.staging / "map.ply", mesh, labelled.labels);
  write_map_obj(context.staging / "map.obj", mesh, labelled.labels, frames);
  std::vector<std::string> written = {"polygons.json", "map.ply", "map.obj"};

  const std::vector<Exporter> exporters = {
      {"map.glb", wanted.glb,
       [&](const fs::path& file) { write_map_glb(file, mesh, labelled_map, frames); }},
      {"cloud.pcd", wanted.pcd,
       [&](const fs::path& file) {
         write_pcd(file, with_scan_numbers(results.cloud.get(), results.world.get()));
       }},
      {"floorplan.svg", wanted.floor_plan && !labelled.rooms.rooms.empty(),
       [&](const fs::path& file) {
         write_floor_plans(file, labelled.rooms, write_floor_plan_svg);
       }},
      {"floorplan.dxf", wanted.dxf && !labelled.rooms.rooms.empty(),
       [&](const fs::path& file) {
         write_floor_plans(file, labelled.rooms, write_floor_plan_dxf);
       }},
      {"map.city.json", wanted.cityjson,
       [&](const fs::path& file) { write_city_json(file, labelled_map); }},
      {"occupancy.yaml", wanted.occupancy,
       [&](const fs::path& file) { write_occupancy(file, context); }},
      {"map.bt", wanted.octomap,
       [&](const fs::path& file) {
         write_octomap(file, results.cloud.get(), scan_origins(results.world.get()),
                       settings.octomap);
       }},
      {"navmesh.bin", wanted.navmesh,
       [&](const fs::path& file) {
         NavmeshParams params = settings.navmesh;
         params.robot_height = settings.occupancy.high;
         params.robot_climb = settings.occupancy.low;
         write_navmesh(file, mesh, labelled_map, params);
       }},
      {"objects.obj",
       wanted.objects &&
           std::any_of(labelled.objects.begin(), labelled.objects.end(),
                       [](const SceneObject& object) { return object.model.has_value(); }),
       [&](const fs::path& file) { write_objects_obj(file, labelled.objects); }},
      {"world/world.sdf", wanted.sdf,
       [&](const fs::path& file) { write_sdf_world(file, mesh, labelled_map); }},
  };
  for (const Exporter& exporter : exporters) {
    if (!exporter.is_wanted) continue;
    try {
      exporter.write(context.staging / exporter.file);
      written.push_back(exporter.file);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::environment) throw;
      context.record.warnings.push_back(warning_of(exporter, error, context.staging));
    }
  }
  context.record.summary = fmt::format("{}", fmt::join(written, ", "));
}

}  // namespace

Stage maps_stage() {
  return {.name = "maps",
          .version = 7,
          .unit = "steps",
          .needs = {"cloud", "mesh", "polygons", "labels"},
          .parameters = {"maps"},
          .input_files = {},
          .work = work};
}

}  // namespace planum
