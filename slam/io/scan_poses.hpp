#pragma once

#include <string>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/io/scan_directory.hpp"

namespace planum {

/// Where scans were taken, as far as files say.
struct ScanPoses {
  std::vector<Pose> world_from_scan;  ///< one a scan of the directory; empty if nothing says
  std::string source;                 ///< "pose files", the path of a file, or "none"
};

/// Reads the poses of a directory's scans from `source`:
/// "auto": the .pose files beside the scans, else odometry.tum beside them, else none;
/// "none": none; a .g2o file: its vertices, by id; any other file: a trajectory in TUM format, by
/// the scans' numbers. A relative path starts from the working directory.
/// Throws Error if a scan has no pose there while others have, or has two.
ScanPoses read_scan_poses(const ScanDirectory& directory, const std::string& source = "auto");

}  // namespace planum
