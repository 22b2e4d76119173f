#include "slam/io/scan_poses.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/g2o.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"

namespace planum {
namespace {

ScanPoses from_pose_files(const ScanDirectory& directory) {
  ScanPoses poses = {.world_from_scan = {}, .source = "pose files"};
  for (const ScanFile& scan : directory.scans) {
    if (scan.pose_file.empty())
      throw Error(
          fmt::format("{}: there is no pose file {}.pose beside it, though other scans have "
                      "theirs: add it or choose poses = \"none\"",
                      scan.file.string(), scan.id));
    poses.world_from_scan.push_back(read_uos_pose(scan.pose_file));
  }
  return poses;
}

Trajectory trajectory_in(const std::filesystem::path& file) {
  if (file.extension() != ".g2o") return read_tum(file);
  Trajectory trajectory;
  for (const G2oVertex& vertex : read_g2o(file).vertices)
    trajectory.push_back(
        {.stamp = static_cast<double>(vertex.id), .pose = vertex.world_from_vertex});
  return trajectory;
}

ScanPoses from_trajectory(const ScanDirectory& directory, const std::filesystem::path& file) {
  std::map<double, Pose> by_number;
  for (const StampedPose& pose : trajectory_in(file))
    if (!by_number.emplace(pose.stamp, pose.pose).second)
      throw Error(fmt::format("{}: there are two poses for number {}", file.string(), pose.stamp));
  ScanPoses poses = {.world_from_scan = {}, .source = file.string()};
  for (const ScanFile& scan : directory.scans) {
    const auto found = by_number.find(scan.number);
    if (found == by_number.end())
      throw Error(
          fmt::format("{}: there is no pose for number {}, which is {} (the first column "
                      "must be the scan's number)",
                      file.string(), scan.number, scan.file.string()));
    poses.world_from_scan.push_back(found->second);
  }
  return poses;
}

}  // namespace

ScanPoses read_scan_poses(const ScanDirectory& directory, const std::string& source) {
  const ScanPoses none = {.world_from_scan = {}, .source = "none"};
  if (source == "none") return none;
  if (source != "auto") return from_trajectory(directory, source);
  if (std::any_of(directory.scans.begin(), directory.scans.end(),
                  [](const ScanFile& scan) { return !scan.pose_file.empty(); }))
    return from_pose_files(directory);
  if (!directory.trajectories.empty() &&
      directory.trajectories.front().filename() == "odometry.tum")
    return from_trajectory(directory, directory.trajectories.front());
  return none;
}

}  // namespace planum
