#include <map>

#include <fmt/format.h>

#include "labeling/labels.hpp"
#include "labeling/rooms.hpp"
#include "meshing/normals.hpp"
#include "meshing/polygons.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "tools/maps/map_mesh.hpp"
#include "tools/maps/polygons_json.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"

namespace planum {
namespace {

struct PolygonizeArguments {
  std::filesystem::path cloud, origins, output;
  SurfaceParams surface;
  WorkArguments work;
};

/// A cloud, and where its scans were taken.
struct SeenCloud {
  Cloud cloud;  ///< `scan` counts the origins
  std::vector<Eigen::Vector3d> origins;
};

/// The scans of a cloud go by the first column of the trajectory. Without one, a scanner at the
/// origin saw everything.
SeenCloud read_seen_cloud(const PolygonizeArguments& arguments) {
  SeenCloud seen{read_ply_cloud(arguments.cloud), {}};
  if (arguments.origins.empty()) {
    seen.origins = {Eigen::Vector3d::Zero()};
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
  auto [cloud, origins] = read_seen_cloud(arguments);
  if (cloud.normals.empty()) {
    cloud.normals = estimate_normals(cloud, origins, {}, console.start_bar("normals", "points"));
  }
  const TriangleMesh mesh =
      reconstruct(cloud, arguments.surface, console.start_bar("mesh", "cells"));
  console.end_bar();
  const double voxel = arguments.surface.voxel;
  const Regions regions = grow_planes(mesh, cloud, region_params(voxel));
  const PolygonMap map = polygonize(mesh, regions, polygon_params(voxel));
  const Labels labels = label(map);
  RoomMap no_rooms;
  no_rooms.room_of_polygon.assign(map.polygons.size(), -1);
  const TriangulatedMap triangles = triangulated(map);

  std::filesystem::create_directories(arguments.output);
  write_ply(arguments.output / "mesh.ply", mesh);
  write_polygons_json(arguments.output / "polygons.json", {map, labels, no_rooms});
  write_map_ply(arguments.output / "map.ply", triangles, labels);
  write_map_obj(arguments.output / "map.obj", triangles, labels);
  fmt::print("{} polygons in {}: polygons.json, map.ply, map.obj, mesh.ply\n", map.polygons.size(),
             arguments.output.string());
}

}  // namespace

void add_polygonize_command(CLI::App& app) {
  const auto arguments = std::make_shared<PolygonizeArguments>();
  CLI::App* command =
      app.add_subcommand("polygonize", "a polygon map of a registered cloud, without a project");
  command->add_option("CLOUD", arguments->cloud, "a .ply file, in metres")->required();
  command
      ->add_option("--origins", arguments->origins,
                   "a .tum file: where the scans of the cloud's `scan` property were taken; "
                   "without it the scanner stood at the origin")
      ->type_name("TRAJECTORY");
  command->add_option("--out", arguments->output, "directory for the map")
      ->type_name("DIR")
      ->required();
  command->add_option("--voxel-m", arguments->surface.voxel, "edge of the grid's cells")
      ->capture_default_str();
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { polygonize_command(*arguments); });
}

}  // namespace planum
