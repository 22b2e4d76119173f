#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

/// When a point is not believed.
struct FreeSpaceParams {
  double cell = 0.1;    ///< m, the points of one cell are judged together
  double margin = 0.1;  ///< m, rays have to end so far behind a point to have gone through there,
  double margin_per_metre =
      0.02;                       ///< and by so much more for each metre: poses are a little turned
  double max_tilt = radians(75);  ///< rad, rays that meet the surface flatter than this, where the
                                  ///< cloud has normals, say nothing
  int min_scans = 2;              ///< of which scans rays went through; 0: all points are believed
};

/// For each point whether it lies where other scans saw nothing: mixed pixels at the edges of
/// things, people who walked by. Such is a cell that at least `min_scans` scans look through, and
/// twice as many as have a point in it. A scan looks through a place if all its returns within
/// about a degree and a half of that direction (so that what is thin, or seen at a flat angle, is
/// not taken for free) are behind the place, and most of these directions have returns.
///
/// `cloud.scan` says which of `scan_origins` saw a point; it may be empty if there is one origin:
/// then all is believed. Throws Error if a point is not finite or has no origin, and for parameters
/// out of range.
std::vector<std::uint8_t> in_free_space(const Cloud& cloud,
                                        std::span<const Eigen::Vector3d> scan_origins,
                                        const FreeSpaceParams& params = {});

/// Takes the normals of points in free space away, so that they stay in the cloud but make no
/// surface. Returns how many these are.
std::size_t drop_normals_in_free_space(Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                                       const FreeSpaceParams& params = {});

}  // namespace planum
