#pragma once

#include <cstdint>
#include <vector>

#include "meshing/borders.hpp"
#include "meshing/corner_snapping.hpp"
#include "meshing/half_edge.hpp"
#include "meshing/regions.hpp"

namespace planum {

/// The points of a border chain on both sides, and which of them a simplified border keeps.
struct ChainShape {
  std::vector<std::uint32_t> left, right;  ///< points of SnappedCorners; right is empty outside
  bool closed = false;
  bool straight = false;          ///< the common line of two planes: only its ends count
  std::vector<std::size_t> kept;  ///< ascending places in left and right

  /// The kept points of one side, forwards.
  std::vector<std::uint32_t> kept_points(bool of_right) const;
};

ChainShape chain_shape(const BorderChain& chain, const HalfEdges& edges,
                       const SnappedCorners& corners, const std::vector<Region>& regions);

/// Chooses what to keep, for borders that stay within max_error (m) of the unsimplified ones.
void simplify(ChainShape& shape, const std::vector<Eigen::Vector3d>& points, double max_error);

}  // namespace planum
