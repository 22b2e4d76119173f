#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

struct DoubleWallParams {
  double patch_radius = 0.25;  ///< m, of the pieces of surface that are compared
  double max_gap = 0.3;        ///< m, surfaces farther apart are not taken for the same
  double separation = 0.03;    ///< m, a void this deep parts two surfaces of one group
  double max_normal_angle =
      radians(25);              ///< rad, points that face more apart are of other surfaces
  double max_thickness = 0.03;  ///< m, rms about its plane; what is thicker is no plane
  std::size_t min_points = 15;  ///< of each group in a patch
  std::size_t max_patches = 0;  ///< evenly chosen; 0: all
};

/// A piece of surface that both groups see.
struct DoubleWallPatch {
  Eigen::Vector3d centre;  ///< m, of the first group's points
  Eigen::Vector3d normal;  ///< unit, of the first group's plane, towards the scanner
  double gap = 0;          ///< m, how far the second group's surface is in front of it
};

/// Over the patches; absolute values in m.
struct DoubleWallGap {
  std::size_t patches = 0;
  double median = 0, mean = 0, percentile_90 = 0, max = 0;
};

/// Double walls: how far the surfaces of two groups of scans, e.g. before and after a loop, lie
/// apart where they see the same wall. For patches of the first group, planes are fitted robustly;
/// of the second group's points before and behind each patch that face the same way, the nearest
/// surface counts, unless the first group has a surface nearer to that: so the sides of a thin wall
/// and furniture in front of one are not taken for a gap. Points without a normal have no part.
/// Throws Error if points have no normals, are not finite, or a parameter is out of range.
std::vector<DoubleWallPatch> double_walls(const Cloud& first, const Cloud& second,
                                          const DoubleWallParams& params = {});

DoubleWallGap double_wall_gap(std::span<const DoubleWallPatch> patches);

}  // namespace planum
