#include <limits>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "meshing/free_space.hpp"
#include "meshing/normals.hpp"
#include "meshing/surface.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/objects/model_library.hpp"
#include "tools/planum/arguments.hpp"
#include "tools/planum/cli11.hpp"
#include "tools/planum/commands.hpp"
#include "tools/planum/console.hpp"
#include "tools/planum/scan_file.hpp"
#include "tools/workflow/map_files.hpp"
#include "tools/workflow/map_steps.hpp"

namespace planum {
namespace {

struct PolygonizeArguments {
  std::filesystem::path cloud, origins, output;
  std::vector<double> origin;   ///< m, x y z; empty: not given
  std::optional<double> voxel;  ///< m
  std::vector<std::string> overrides;
  WorkArguments work;
};

/// A cloud, and where its scans were taken.
struct SeenCloud {
  Cloud cloud;                           ///< `scan` counts the origins
  std::vector<Eigen::Vector3d> origins;  ///< m; none: nobody says where
  std::vector<std::uint32_t> numbers;    ///< of the scans
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
/// place given saw everything.
SeenCloud read_seen_cloud(const PolygonizeArguments& arguments, Console& console) {
  SeenCloud seen{read_cloud(arguments.cloud, console), {}, {}};
  if (arguments.origins.empty()) {
    if (!arguments.origin.empty()) seen.origins = {Eigen::Vector3d::Map(arguments.origin.data())};
    seen.numbers = {0};
    seen.cloud.scan.assign(seen.cloud.points.size(), 0);
    return seen;
  }
  std::map<double, std::uint32_t> line_of;
  for (const StampedPose& pose : read_tum(arguments.origins)) {
    line_of.emplace(pose.stamp, static_cast<std::uint32_t>(seen.origins.size()));
    seen.origins.push_back(pose.pose.translation());
    const bool is_number =
        pose.stamp >= 0 && pose.stamp <= std::numeric_limits<std::uint32_t>::max();
    seen.numbers.push_back(is_number ? static_cast<std::uint32_t>(pose.stamp) : 0);
  }
  if (seen.cloud.scan.empty() && seen.origins.size() > 1)
    throw Error(
        fmt::format("{}: points do not know their scan (no property `scan`), so it is "
                    "unknown which of the {} places in {} saw them",
                    arguments.cloud.string(), seen.origins.size(), arguments.origins.string()));
  if (seen.cloud.scan.empty())
    seen.cloud.scan.assign(seen.cloud.points.size(), 0);
  else
    for (std::uint32_t& scan : seen.cloud.scan) {
      const auto line = line_of.find(scan);
      if (line == line_of.end())
        throw Error(fmt::format("{}: a point is of scan {}, which {} does not have",
                                arguments.cloud.string(), scan, arguments.origins.string()));
      scan = line->second;
    }
  return seen;
}

/// Without the place of the scanner nothing is known of free space, and so of what is made from it.
void leave_out_free_space(MapSettings& maps) { maps.occupancy = maps.octomap = false; }

Settings settings_of(const PolygonizeArguments& arguments) {
  Settings settings = default_settings(arguments.overrides);
  if (arguments.voxel) settings.surface.voxel = *arguments.voxel;
  return settings;
}

void polygonize_command(const PolygonizeArguments& arguments) {
  set_thread_count(arguments.work.threads);
  Console console(arguments.work.quiet);
  Settings settings = settings_of(arguments);
  auto [cloud, origins, numbers] = read_seen_cloud(arguments, console);
  const bool is_place_known = !origins.empty();
  if (!is_place_known) {
    console.warn(fmt::format(
        "nobody says where the scanner stood (--origin, --origins){}; there are no rooms, no "
        "objects, no occupancy.yaml and no map.bt",
        cloud.normals.empty() ? ": it is taken to be at 0 0 0, and surfaces face that place" : ""));
    leave_out_free_space(settings.maps);
  }
  if (cloud.normals.empty()) {
    const std::vector<Eigen::Vector3d> guess{Eigen::Vector3d::Zero()};
    cloud.normals = estimate_normals(cloud, is_place_known ? origins : guess, settings.normals,
                                     console.start_bar("normals", "points"));
  }
  if (is_place_known) drop_normals_in_free_space(cloud, origins, settings.free_space);
  const TriangleMesh mesh =
      reconstruct(cloud, settings.surface, console.start_bar("mesh", "cells"));
  console.end_bar();
  const PolygonMap map = polygon_map(mesh, cloud, origins, settings);
  const Labelled labelled = labelled_map(
      map, cloud, origins,
      settings.models.empty() ? std::vector<std::filesystem::path>() : model_files(settings.models),
      settings);

  std::filesystem::create_directories(arguments.output);
  write_ply(arguments.output / "mesh.ply", mesh);
  MapFiles files = write_map_files(arguments.output,
                                   {.cloud = cloud,
                                    .origins = origins,
                                    .scan_numbers = numbers,
                                    .mesh = mesh,
                                    .polygons = map,
                                    .labelled = labelled},
                                   settings);
  if (const auto why = why_not_level(labelled.labels)) console.warn("no rooms: " + *why);
  for (const std::string& warning : files.warnings) console.warn(warning);
  files.written.push_back("mesh.ply");
  fmt::print("{} polygons in {}: {}\n", map.polygons.size(), arguments.output.string(),
             fmt::join(files.written, ", "));
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
  command->add_option("--voxel-m", arguments->voxel, "edge of the grid's cells, as mesh.voxel_m");
  add_overrides(*command, arguments->overrides, "maps.robot_high_m=0.8");
  add_work_arguments(*command, arguments->work);
  command->callback([arguments] { polygonize_command(*arguments); });
}

}  // namespace planum
