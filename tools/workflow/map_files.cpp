#include "tools/workflow/map_files.hpp"

#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

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
#include "tools/workflow/map_steps.hpp"

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
void write_occupancy(const fs::path& path, const MapSources& sources,
                     const OccupancyParams& params) {
  const Labels& labels = sources.labelled.labels;
  const std::vector<double> floors = storey_floors(sources.polygons, labels);
  if (floors.empty()) throw Error(path.string() + ": there is no floor for a robot");
  for (std::size_t i = 0; i < floors.size(); ++i) {
    const std::string ending = floors.size() == 1 ? ".yaml" : fmt::format("_{}.yaml", i + 1);
    const OccupancyGrid storey =
        occupancy_grid(sources.cloud, sources.origins, sources.mesh, floors[i], params);
    write_occupancy_map(path.parent_path() / ("occupancy" + ending), storey);
    write_occupancy_map(path.parent_path() / ("keepout" + ending),
                        keepout_mask(sources.polygons, labels, storey, {.max_step = params.low}));
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
std::string warning_of(const Exporter& exporter, const Error& error, const fs::path& folder) {
  const std::string text = error.what(), start = (folder / exporter.file).string() + ": ";
  return fmt::format("no {}: {}", exporter.file,
                     text.starts_with(start) ? text.substr(start.size()) : text);
}

Cloud with_numbers(Cloud cloud, std::span<const std::uint32_t> numbers) {
  for (std::uint32_t& scan : cloud.scan) scan = numbers[scan];
  return cloud;
}

void check_level(const fs::path& file, const Labels& labels) {
  if (const auto why = why_not_level(labels)) throw Error(file.string() + ": " + *why);
}

}  // namespace

MapFiles write_map_files(const fs::path& folder, const MapSources& sources,
                         const Settings& settings) {
  const MapSettings& wanted = settings.maps;
  const PolygonMap& map = sources.polygons;
  const Labelled& labelled = sources.labelled;
  const LabelledMap building{map, labelled.labels, labelled.rooms, labelled.objects};
  const TriangulatedMap mesh = triangulated(map);
  const std::vector<TextureFrame> frames =
      wanted.textures ? texture_frames(map, labelled.labels) : std::vector<TextureFrame>();

  write_polygons_json(folder / "polygons.json", building);
  write_map_ply(folder / "map.ply", mesh, labelled.labels);
  write_map_obj(folder / "map.obj", mesh, labelled.labels, frames);
  MapFiles files{{"polygons.json", "map.ply", "map.obj"}, {}};

  const std::vector<Exporter> exporters = {
      {"map.glb", wanted.glb,
       [&](const fs::path& file) { write_map_glb(file, mesh, building, frames); }},
      {"cloud.pcd", wanted.pcd,
       [&](const fs::path& file) {
         write_pcd(file, with_numbers(sources.cloud, sources.scan_numbers));
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
       [&](const fs::path& file) { write_city_json(file, building); }},
      {"occupancy.yaml", wanted.occupancy,
       [&](const fs::path& file) {
         check_level(file, labelled.labels);
         write_occupancy(file, sources, settings.occupancy);
       }},
      {"map.bt", wanted.octomap,
       [&](const fs::path& file) {
         write_octomap(file, sources.cloud, sources.origins, settings.octomap);
       }},
      {"navmesh.bin", wanted.navmesh,
       [&](const fs::path& file) {
         check_level(file, labelled.labels);
         NavmeshParams params = settings.navmesh;
         params.robot_height = settings.occupancy.high;
         params.robot_climb = settings.occupancy.low;
         write_navmesh(file, mesh, building, params);
       }},
      {"objects.obj",
       wanted.objects &&
           std::any_of(labelled.objects.begin(), labelled.objects.end(),
                       [](const SceneObject& object) { return object.model.has_value(); }),
       [&](const fs::path& file) { write_objects_obj(file, labelled.objects); }},
      {"world/world.sdf", wanted.sdf,
       [&](const fs::path& file) { write_sdf_world(file, mesh, building); }},
  };
  for (const Exporter& exporter : exporters) {
    if (!exporter.is_wanted) continue;
    try {
      exporter.write(folder / exporter.file);
      files.written.push_back(exporter.file);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::environment) throw;
      files.warnings.push_back(warning_of(exporter, error, folder));
    }
  }
  return files;
}

}  // namespace planum
