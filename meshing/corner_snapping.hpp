#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "meshing/half_edge.hpp"
#include "meshing/regions.hpp"

namespace planum {

struct SnapParams {
  double max_move = 0.1;     ///< m, vertices go no farther to meet several planes
  double max_offset = 5e-4;  ///< m, a vertex this near to a plane lies in it
};

/// The vertices of borders moved onto the planes that meet there. Where planes do not meet nearby
/// (a step of two parallel planes) a vertex becomes several, and `fill` closes what opens between
/// them at vertices with three or more.
struct SnappedCorners {
  static constexpr std::uint32_t none = HalfEdges::none;

  std::vector<Eigen::Vector3d> points;  ///< m
  std::vector<std::uint32_t> start;   ///< for each half-edge on a border, the point where it starts
  std::vector<std::uint32_t> end;     ///< ... and where it ends
  std::vector<std::uint32_t> corner;  ///< for each corner 3 f + k of a rest triangle, the point it
                                      ///< shares with a border, or none
  std::vector<std::array<std::uint32_t, 3>> fill;  ///< triangles of points
};

SnappedCorners snapped_corners(const std::vector<Region>& regions, const TriangleMesh& mesh,
                               const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                               const SnapParams& params);

}  // namespace planum
