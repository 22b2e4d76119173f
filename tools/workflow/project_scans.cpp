#include "tools/workflow/project_scans.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/uos.hpp"
#include "slam/io/xyz.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum {
namespace {

/// The header of a scan with the values of the project's [sensor] table.
RawScan with_overrides(RawScan scan, const SensorSettings& sensor) {
  const auto replace = [](double& value, const std::optional<double>& by) {
    if (by) value = *by;
  };
  replace(scan.laser.first_beam, sensor.first_beam);
  replace(scan.laser.beam_step, sensor.beam_step);
  replace(scan.laser.min_range, sensor.min_range);
  replace(scan.laser.max_range, sensor.max_range);
  replace(scan.laser.beam_interval, sensor.beam_interval);
  replace(scan.laser.mount_x, sensor.mount_x);
  replace(scan.laser.mount_z, sensor.mount_z);
  for (Slice& slice : scan.slices) slice.tilt += sensor.tilt_offset;
  return scan;
}

/// "auto" and "none" are words, all else is a path that starts at the project file.
std::string pose_source(const Project& project) {
  const std::string& source = project.settings.scan_poses;
  return source == "auto" || source == "none" ? source : resolved(project, source).string();
}

}  // namespace

ScanDirectory scan_files(const Project& project) {
  return list_scans(resolved(project, project.settings.scan_directory),
                    project.settings.scan_format);
}

ScanPoses scan_poses(const Project& project, const ScanDirectory& directory) {
  ScanPoses poses = read_scan_poses(directory, pose_source(project));
  poses.source = std::filesystem::path(poses.source).filename().string();
  return poses;
}

std::vector<std::filesystem::path> pose_files(const Project& project,
                                              const ScanDirectory& directory) {
  const std::string source = pose_source(project);
  if (source == "none") return {};
  if (source != "auto") return {source};
  std::vector<std::filesystem::path> files;
  for (const ScanFile& scan : directory.scans) {
    if (!scan.pose_file.empty()) files.push_back(scan.pose_file);
  }
  if (files.empty() && !directory.trajectories.empty() &&
      directory.trajectories.front().filename() == "odometry.tum") {
    files.push_back(directory.trajectories.front());
  }
  return files;
}

ImportedScan read_scan(const ScanFile& file, ScanFormat format, const Settings& settings) {
  const auto read = [&]() -> ImportedScan {
    switch (format) {
      case ScanFormat::slices:
        return points_from_slices(with_overrides(read_slices(file.file), settings.sensor),
                                  settings.limits);
      case ScanFormat::uos:
        return limited(read_uos_scan(file.file), settings.limits);
      case ScanFormat::ply:
        return limited(read_ply_cloud(file.file), settings.limits);
      case ScanFormat::xyz:
        return limited(read_xyz(file.file), settings.limits);
    }
    throw Error(fmt::format("{}: unknown format", file.file.string()));
  };
  ImportedScan scan = read();
  try {
    check_import(scan.counts, settings.limits);
  } catch (Error& error) {
    error.add_context(file.file.string());
    throw;
  }
  return scan;
}

}  // namespace planum
