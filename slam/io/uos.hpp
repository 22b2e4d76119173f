#pragma once

#include <filesystem>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

/// The UOS format of 3DTK: left-handed, centimetres, x right, y up, z forward. What is read comes
/// in the frames and units of this project: x = z_uos / 100, y = -x_uos / 100, z = y_uos / 100.

/// Reads `scanNNN.3d`: lines `x y z [intensity ...]`, after an optional first line `N x M`. Points
/// may be nan or inf. Throws Error `path:line` for lines that are something else, and if there is
/// no point.
Cloud read_uos_scan(const std::filesystem::path& path);

/// Writes points, and intensities if there are any.
void write_uos_scan(const std::filesystem::path& path, const Cloud& cloud);

/// Reads `scanNNN.pose`: `x y z` in cm and three angles in degrees, R = Rx Ry Rz.
/// Returns world_from_scan; throws Error unless there are exactly six finite numbers.
Pose read_uos_pose(const std::filesystem::path& path);

void write_uos_pose(const std::filesystem::path& path, const Pose& world_from_scan);

/// A pose as its file has it: position in cm, angles in degrees, R = Rx Ry Rz.
Pose pose_from_uos(const Eigen::Vector3d& position, const Eigen::Vector3d& angles);

/// A rigid transform of 3DTK (homogeneous matrix, cm) in the conventions of this project, and back.
Pose pose_from_uos(const Eigen::Matrix4d& transform);
Eigen::Matrix4d uos_from_pose(const Pose& pose);

}  // namespace planum
