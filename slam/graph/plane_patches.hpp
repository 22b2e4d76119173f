#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/plane.hpp"
#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

/// A small piece of surface as one scan sees it: the local plane around one of its points.
struct Surfel {
  std::uint32_t scan = 0;
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< m, scanner frame, mean of its points
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, towards the scanner
  float tilt_variance = 0;                           ///< rad^2, of the normal
  float offset_variance = 0;                         ///< m^2, of the point along the normal
  bool held_out = false;                             ///< judges what the others make
};

/// The surfels of all scans, about one in each voxel of edge `spacing` (m) of a scan. Whole blocks
/// of neighbours, one of four, are held out. The choice depends on nothing but the scan.
std::vector<Surfel> surfels(std::span<const MatchingScan> scans, double spacing);

/// The surfels that are not held out, in the order in which patches begin at them: the least tilted
/// first. It does not depend on the order of the scans.
std::vector<std::uint32_t> surest_first(std::span<const Surfel> surfels);

/// A piece of a plane, of limited size because no wall is flat over its whole length, and what all
/// scans see of it. All its surfels face the same way: a thin wall has patches on either side.
struct PlanePatch {
  Plane plane;                         ///< world; its normal is on the side of the scanners
  std::vector<std::uint32_t> surfels;  ///< ascending
};

struct PatchParams {
  double radius = 0.75;            ///< m, of a patch about its seed
  double gate = 0.03;              ///< m, surfels farther off the plane are not of it
  double max_angle = radians(15);  ///< rad, nor are those whose normals are more apart
  std::size_t least_surfels = 12;  ///< of a patch, held-out ones not counted
  double least_width = 0.12;       ///< m, rms across: narrower patches show no plane
};

/// Covers the surfaces that the scans see with patches: the first of `seeds` that is in none yet is
/// where the next one begins. Each surfel is in one patch at most. Scans of different parts
/// (`part_of_scan`; empty: all are one) share no patch. The same for any frame of the world and any
/// order of the scans.
std::vector<PlanePatch> plane_patches(std::span<const Surfel> surfels,
                                      std::span<const std::uint32_t> seeds,
                                      std::span<const Pose> world_from_scan,
                                      std::span<const std::size_t> part_of_scan,
                                      const PatchParams& params);

}  // namespace planum
