#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace planum {

/// In what format scans are kept.
enum class ScanFormat { uos, slices, ply, xyz };

/// As a user names it: "uos", "slices", "ply", "xyz".
const char* name(ScanFormat format);

/// One scan of a directory.
struct ScanFile {
  std::string id;  ///< the file's name without its ending, e.g. "scan007"
  int number = 0;  ///< the last group of digits in it, e.g. 7
  std::filesystem::path file;
  std::filesystem::path pose_file;  ///< the `.pose` file beside it; empty if there is none
};

/// The scans of a directory in the order of their numbers.
struct ScanDirectory {
  std::filesystem::path path;
  ScanFormat format = ScanFormat::uos;
  std::vector<ScanFile> scans;
  /// The `.tum` files beside the scans, `odometry.tum` first, then by name.
  std::vector<std::filesystem::path> trajectories;
};

/// Looks for scans by the endings .3d (uos), .slices (slices), .ply and .xyz; a .txt file is a scan
/// if it looks like slices. With `format` other than "auto" only such files count: .txt also as
/// slices, and .txt, .dat, .asc, .pts as xyz. Files without a number in their name are not scans,
/// unless there is just one file that could be a scan: that has number 0.
/// Throws Error if the directory is missing, there is no scan in it, two have the same number
/// (names both), scans are in several formats (names them), or the format is unknown.
ScanDirectory list_scans(const std::filesystem::path& directory,
                         const std::string& format = "auto");

}  // namespace planum
