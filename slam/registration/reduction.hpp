#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"

namespace planum {

/// Points sorted into voxels, which are numbered in the order in which they are first seen.
struct VoxelGrid {
  std::vector<std::uint32_t> voxel_of_point;
  /// For each voxel the point nearest the mean of the points in it; ties go to the first point. A
  /// real point, because the mean does not lie on the surface where that bends, and the voxel's
  /// centre lies on it nowhere.
  std::vector<std::uint32_t> representative;
};

/// Throws Error if the voxel (edge in m) is not positive, or a point is not finite or farther from
/// the origin than 2^20 voxels.
VoxelGrid voxel_grid(std::span<const Eigen::Vector3f> points, double voxel);

/// The cloud of the representative points of a voxel grid with their attributes; voxel 0 keeps
/// every point.
Cloud reduced(const Cloud& cloud, double voxel);

}  // namespace planum
