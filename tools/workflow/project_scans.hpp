#pragma once

#include <filesystem>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/io/scan_directory.hpp"
#include "slam/io/scan_poses.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/workflow/project.hpp"

namespace planum {

/// The scan files that a project names. Throws Error like list_scans.
ScanDirectory scan_files(const Project& project);

/// The poses that came with the scans. Throws Error like read_scan_poses.
ScanPoses scan_poses(const Project& project, const ScanDirectory& directory);

/// The files that scan_poses reads.
std::vector<std::filesystem::path> pose_files(const Project& project,
                                              const ScanDirectory& directory);

/// Reads one scan of any format: its usable points in the scanner's frame, and what was dropped.
/// Throws Error for a file that cannot be read and for a scan that cannot be trusted.
ImportedScan read_scan(const ScanFile& file, ScanFormat format, const Settings& settings);

}  // namespace planum
