#pragma once

#include <cstdint>
#include <vector>

#include "meshing/region_lookup.hpp"
#include "meshing/regions.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// For each point the region of the mesh it lies in: near a triangle of the region, and agreeing
/// with its plane in distance (m) and, if the cloud has normals, in direction (rad).
struct PointRegions {
  static constexpr std::uint32_t none = Regions::rest;
  static constexpr std::uint32_t several = Regions::rest - 1;  ///< of which none is the right one

  std::vector<std::uint32_t> of_point;
  RegionLookup lookup;  ///< where the regions are
};

/// Throws Error for a point that is not finite and for inputs that do not belong together.
PointRegions point_regions(const Regions& regions, const TriangleMesh& mesh, const Cloud& cloud,
                           double max_distance, double max_angle);

}  // namespace planum
