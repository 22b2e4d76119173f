#include "tools/workflow/map_steps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "labeling/objects/object_models.hpp"
#include "labeling/objects/objects.hpp"
#include "labeling/occupancy.hpp"
#include "labeling/reflections.hpp"
#include "labeling/rooms/blind_windows.hpp"
#include "labeling/rooms/storeys.hpp"
#include "meshing/laser_shadows.hpp"
#include "meshing/polygons.hpp"
#include "meshing/regions.hpp"
#include "slam/core/pose.hpp"
#include "tools/objects/model_library.hpp"

namespace planum {
namespace {

constexpr double level_enough = radians(5);

/// What suits the voxels of the mesh, where the settings do not say otherwise.
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

RoomMap rooms_of(const Labels& labels, const PolygonMap& map, const Cloud& cloud,
                 std::span<const Eigen::Vector3d> origins, const RoomParams& params) {
  if (origins.empty() || why_not_level(labels)) {
    RoomMap none;
    none.room_of_polygon.assign(map.polygons.size(), -1);
    return none;
  }
  const std::vector<double> floors = storey_floors(map, labels);
  return with_blind_windows(map, labels,
                            find_rooms_of_storeys(cloud, origins, map, floors, params));
}

}  // namespace

PolygonMap polygon_map(const TriangleMesh& mesh, const Cloud& cloud,
                       std::span<const Eigen::Vector3d> origins, const Settings& settings,
                       const Progress& progress) {
  constexpr std::size_t steps = 3;
  progress.report(0, steps);
  const Regions regions = grow_planes(mesh, cloud, chosen_region_params(settings));
  progress.report(1, steps);
  PolygonMap polygons = polygonize(mesh, regions, chosen_polygon_params(settings));
  progress.report(2, steps);
  if (origins.empty()) return polygons;
  return with_shadows_filled(std::move(polygons), cloud, origins, settings.shadows);
}

Labelled labelled_map(const PolygonMap& map, const Cloud& cloud,
                      std::span<const Eigen::Vector3d> origins,
                      const std::vector<std::filesystem::path>& model_files,
                      const Settings& settings, const Progress& progress) {
  constexpr std::size_t steps = 3;
  Labelled made;
  progress.report(0, steps);
  made.labels = label(map, settings.labels);
  progress.report(1, steps);
  made.rooms = rooms_of(made.labels, map, cloud, origins, settings.rooms);
  made.labels = without_reflections(
      map, with_openings(map, std::move(made.labels), made.rooms.openings), made.rooms);
  progress.report(2, steps);
  if (origins.empty()) return made;
  made.objects =
      with_models(find_objects(cloud, map, made.labels, made.rooms, settings.objects), cloud,
                  origins, model_files.empty() ? built_in_models() : read_models(model_files));
  return made;
}

std::optional<std::string> why_not_level(const Labels& labels) {
  const double tilt = std::acos(std::clamp(labels.up.z(), -1.0, 1.0));
  if (tilt <= level_enough) return std::nullopt;
  return fmt::format("the world is {:.0f} degrees from level", degrees(tilt));
}

}  // namespace planum
