#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// A hole in a polygon, or a notch in its outer border that begins and ends where the polygon meets
/// its neighbours.
struct PlaneGap {
  static constexpr std::uint32_t unnamed = 0xffffffffu;

  std::uint32_t polygon = 0;
  std::vector<Eigen::Vector3d> outer = {};  ///< m, counter-clockwise seen from free space
  Ring names = {};                          ///< vertices of the map, `unnamed` for a new corner
  std::size_t first = 0, edges = 0;         ///< of the outer ring, which a notch begins with in
                                            ///< reverse; a hole has 0 edges of it
  std::vector<std::uint32_t> islands = {};  ///< polygons in the same plane inside
  double area = 0;                          ///< m^2, without islands
};

struct PlaneGapParams {
  double min_area = 0.02;        ///< m^2
  double max_area = 4;           ///< m^2
  double min_free_border = 0.5;  ///< share of the border that no other polygon shares
};

/// All holes, and all notches that close in one of these ways: straight, where their border leaves
/// the line of a neighbour and comes back to it; or by the corner where two neighbours meet.
/// Notches may overlap.
std::vector<PlaneGap> plane_gaps(const PolygonMap& map, const PlaneGapParams& params = {});

/// In the plane of the gap's polygon: the outer ring, then those of the islands.
std::vector<Ring2d> rings_of(const PlaneGap& gap, const PolygonMap& map, const PlaneFrame& frame);

/// Whether two notches have an edge of a polygon's border in common.
bool overlap(const PlaneGap& a, const PlaneGap& b, const PolygonMap& map);

}  // namespace planum
