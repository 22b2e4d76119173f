#include <map>

#include <fmt/format.h>

#include "labeling/labels.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/free_space.hpp"
#include "meshing/laser_shadows.hpp"
#include "meshing/normals.hpp"
#include "meshing/polygons.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/maps/map_glb.hpp"
#include "tools/maps/map_mesh.hpp"
#include "tools/maps/polygons_json.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/planum/scan_file.hpp"

namespace planum {
namespace {

struct PolygonizeArguments {
  std::filesystem::path cloud, origins, output;
  std::vector<double> origin;  ///< m, x y z; empty: not given
  SurfaceParams surface;
  WorkArguments work;
};

/// A cloud, and where its scans were taken.
struct SeenCloud {
  Cloud cloud;  ///< `scan` counts the origins
  std::vector<Eigen::Vector3d> origins;
};

/// The points of a file that are points: scanners write nan, inf or zero for beams that met
/// nothing.
Cloud read_cloud(const std::filesystem::path& file, Console& console) {
  const std::optional<Cloud> read = read_points_file(file);
  if (!read)
    throw Error(file.string() +
                ": no file of points by its ending; there are .ply .3d .xyz .pts .asc .dat .txt "
                ".vtk and .slices");
  if (read->points.empty()) throw Error(file.string() + ": there are no points in it");
  ImportedScan finite = limited(*read, {.min_range = 0, .max_range = 0, .max_not_finite = 1});
  if (finite.cloud.points.empty()) throw Error(file.string() + ": not one of its points is finite");
  if (const std::size_t lost = finite.counts.not_finite; lost > 0)
    console.warn(fmt::format("{}: {} of {} points are not finite and are left out", file.string(),
                             lost, read->points.size()));
  for (Eigen::Vector3f& normal : finite.cloud.normals)
    if (!normal.allFinite()) normal.setZero();
  return std::move(finite.cloud);
}

/// The scans of a cloud go by the first column of the trajectory. Without one, a scanner at the
/// origin of the frame, or at the place given, saw everything.
SeenCloud read_seen_cloud(const PolygonizeArguments& arguments, Console& console) {
  SeenCloud seen{read_cloud(arguments.cloud, console), {}};
  if (arguments.origins.empty()) {
    seen.origins = {Eigen::Vector3d::Zero()};
    if (!arguments.origin.empty())
      seen.origins = {Eigen::Vector3d::Map(arguments.origin.data())};
    else if (seen.cloud.normals.empty())
      console.warn(
          "nobody says where the scanner stood (--origin, --origins): it is taken to be at 0 0 0, "
          "and surfaces face that place");
    seen.cloud.scan.clear();
    return seen;
  }
  std::map<double, std::uint32_t> line_of;
  for (const StampedPose& pose : read_tum(arguments.origins)) {
    line_of.emplace(pose.stamp, static_cast<std::uint32_t>(seen.origins.size()));
    seen.origins.push_back(pose.pose.translation());
  }
  if (seen.cloud.scan.empty() && seen.origins.size() > 1)
    throw Error(
        fmt::format("{}: points do not know their scan (no property `scan`), so it is "
                    "unknown which of the {} places in {} saw them",
                    arguments.cloud.string(), seen.origins.size(), arguments.origins.string()));
  for (std::uint32_t& scan : seen.cloud.scan) {
    const auto line = line_of.find(scan);
    if (line == line_of.end())
      throw Error(fmt::format("{}: a point is of scan {}, which {} does not have",
                              arguments.cloud.string(), scan, arguments.origins.string()));
    scan = line->second;
  }
  return seen;
}

void polygonize_command(const PolygonizeArguments& arguments) {
  set_thread_count(arguments.work.threads);
  Console console(arguments.work.quiet);
  auto [cloud, origins] = read_seen_cloud(arguments, console);
  if (cloud.normals.empty()) {
    cloud.normals = estimate_normals(cloud, origins, {}, console.start_bar("normals", "points"));
  }
  drop_normals_in_free_space(cloud, origins);
  const TriangleMesh mesh =
      reconstruct(cloud, arguments.surface, console.start_bar("mesh", "cells"));
  console.end_bar();
  const double voxel = arguments.surface.voxel;
  const Regions regions = grow_planes(mesh, cloud, region_params(voxel));
  const PolygonMap map =
      with_shadows_filled(polygonize(mesh, regions, polygon_params(voxel)), cloud, origins);
  const Labels labels = label(map);
  RoomMap no_rooms;
  no_rooms.room_of_polygon.assign(map.polygons.size(), -1);
  const TriangulatedMap triangles = triangulated(map);

  std::filesystem::create_directories(arguments.output);
  write_ply(arguments.output / "mesh.ply", mesh);
  write_polygons_json(arguments.output / "polygons.json", {map, labels, no_rooms});
  write_map_ply(arguments.output / "map.ply", triangles, labels);
  write_map_obj(arguments.output / "map.obj", triangles, labels);
  if (!triangles.mesh.triangles.empty())
    write_map_glb(arguments.output / "map.glb", triangles, {map, labels, no_rooms});
  fmt::print("{} polygons in {}: polygons.json, map.ply, map.obj, map.glb, mesh.ply\n",
             map.polygons.size(), arguments.output.string());
}

}  // namespace

void add_polygonize_command(CLI::App& app) {
  const auto arguments = std::make_shared<PolygonizeArguments>();
  CLI::App* command =
      app.add_subcommand("polygonize", "a polygon map of a registered cloud, without a project");
  command
      ->add_option("CLOUD", arguments->cloud,
                   "points in metres: .ply .3d .xyz .pts .asc .dat .txt .vtk .slices")
      ->required();
  command
      ->add_option("--origins", arguments->origins,
                   "a .tum file: where the scans of the cloud's `scan` property were taken")
      ->type_name("TRAJECTORY");
  command
      ->add_option("--origin", arguments->origin,
                   "where the scanner stood, in metres, if one place saw all")
      ->type_name("X Y Z")
      ->expected(3)
      ->excludes("--origins");
  command->add_option("--out", arguments->output, "directory for the map")
      ->type_name("DIR")
      ->required();
  command->add_option("--voxel-m", arguments->surface.voxel, "edge of the grid's cells")
      ->capture_default_str();
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { polygonize_command(*arguments); });
}

}  // namespace planum
