#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

/// Reads lines `x y z yaw pitch roll`, m and degrees, R = Rz(yaw) Ry(pitch) Rx(roll). Throws Error
/// `path:line` for other lines and numbers that are not finite, and if there is no pose.
std::vector<Pose> read_pose_list(const std::filesystem::path& path);

void write_pose_list(const std::filesystem::path& path, std::span<const Pose> poses);

}  // namespace planum
