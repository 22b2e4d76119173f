#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshing/level_planes.hpp"
#include "meshing/normals.hpp"
#include "meshing/up_direction.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/evaluation/surface_placement.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/scan_directory.hpp"
#include "slam/io/scan_poses.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/xyz.hpp"
#include "slam/sensor/range_limits.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum::testing {

/// Scans at their true poses in a levelled world, and what is known of the building.
struct TrueDataset {
  std::string poses_from;                ///< for people
  Cloud cloud;                           ///< without normals; `scan` counts the origins
  std::vector<Eigen::Vector3d> origins;  ///< m, where the scans were taken
  std::optional<TriangleMesh> model;     ///< building.obj
  nlohmann::json dimensions;             ///< dimensions.json; null if there is none
  std::optional<Pose> model_from_world;  ///< empty without a model and without true_poses.txt
};

namespace true_dataset {

namespace fs = std::filesystem;

inline Cloud read_points(const fs::path& file, ScanFormat format) {
  switch (format) {
    case ScanFormat::slices:
      return points_from_slices(read_slices(file)).cloud;
    case ScanFormat::uos:
      return limited(read_uos_scan(file)).cloud;
    case ScanFormat::ply:
      return limited(read_ply_cloud(file)).cloud;
    case ScanFormat::xyz:
      return limited(read_xyz(file)).cloud;
  }
  throw Error(file.string() + ": unknown format");
}

/// The best poses there are: those of the building, else of the truth, else what came with it.
inline ScanPoses best_poses(const fs::path& directory, const ScanDirectory& scans) {
  const fs::path absolute = directory / "true_poses.txt", relative = directory / "truth.tum";
  if (fs::exists(absolute)) return {read_pose_list(absolute), absolute.string()};
  ScanPoses poses = read_scan_poses(scans, fs::exists(relative) ? relative.string() : "auto");
  if (!poses.world_from_scan.empty()) return poses;
  if (scans.scans.size() == 1) return {{Pose::Identity()}, "none"};
  throw Error(directory.string() + ": nothing says where the scans were taken");
}

/// As in a run, the world is the frame of the first scan before it is levelled.
inline std::vector<Scan> registered(const ScanDirectory& directory, const ScanPoses& poses) {
  const std::vector<Pose>& given = poses.world_from_scan;
  if (given.size() != directory.scans.size())
    throw Error(poses.source + ": there are not as many poses as scans");
  std::vector<Scan> scans(given.size());
  parallel_for(scans.size(), 1, [&](std::size_t i, std::size_t) {
    const ScanFile& file = directory.scans[i];
    scans[i] = {.id = file.id,
                .number = file.number,
                .world_from_scan = given.front().inverse() * given[i],
                .cloud = read_points(file.file, directory.format)};
  });
  return scans;
}

/// The turn about the first scan after which floors are level; identity if there are none.
inline Pose levelling(Cloud cloud, const std::vector<Eigen::Vector3d>& origins) {
  cloud.normals = estimate_normals(cloud, origins);
  const auto found = estimate_up(cloud.normals, {}, Eigen::Vector3d::UnitZ());
  if (!found) return Pose::Identity();
  const Eigen::Vector3d up = up_of_planes(cloud, found->up);
  return Pose(turn_between(up, Eigen::Vector3d::UnitZ()));
}

inline std::optional<Pose> place_in_model(const TrueDataset& data) {
  if (!data.model) return std::nullopt;
  Cloud cloud = data.cloud;
  cloud.normals = estimate_normals(cloud, data.origins);
  return place_on_surface(cloud, *data.model, SurfaceTree(*data.model)).surface_from_points;
}

}  // namespace true_dataset

/// Reads the scans of a directory (or of `scans` in it) and the truth beside them: true_poses.txt,
/// truth.tum, building.obj and dimensions.json, as far as they are there. Throws Error if a file
/// cannot be read or nothing says where the scans were taken.
inline TrueDataset read_true_dataset(const std::filesystem::path& directory,
                                     const std::string& format = "auto") {
  using namespace true_dataset;
  const fs::path inner = directory / "scans";
  const ScanDirectory files = list_scans(fs::exists(inner) ? inner : directory, format);
  const ScanPoses poses = best_poses(directory, files);
  const std::vector<Scan> scans = registered(files, poses);
  TrueDataset data;
  data.poses_from = poses.source;
  data.cloud = merged(scans);
  for (const Scan& scan : scans) data.origins.push_back(scan.world_from_scan.translation());
  const Pose level_from_first = levelling(data.cloud, data.origins);
  data.cloud = transformed(data.cloud, level_from_first);
  for (Eigen::Vector3d& origin : data.origins) origin = level_from_first * origin;
  if (fs::exists(directory / "building.obj"))
    data.model = read_obj(directory / "building.obj").mesh;
  if (fs::exists(directory / "dimensions.json"))
    data.dimensions = nlohmann::json::parse(read_file(directory / "dimensions.json"));
  data.model_from_world = fs::exists(directory / "true_poses.txt")
                              ? poses.world_from_scan.front() * level_from_first.inverse()
                              : place_in_model(data);
  return data;
}

}  // namespace planum::testing
