#pragma once

#include <filesystem>

#include "slam/core/trajectory.hpp"

namespace planum {

/// Reads a trajectory in the format of the TUM RGB-D benchmark: lines `stamp x y z qx qy qz qw`;
/// the stamp is the scan's number or a time. Throws Error `path:line` for other lines, for numbers
/// that are not finite and for quaternions not of unit length, and if there is no pose.
Trajectory read_tum(const std::filesystem::path& path);

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory);

}  // namespace planum
