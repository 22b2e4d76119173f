#pragma once

#include <cstdint>
#include <vector>

#include "meshing/half_edge.hpp"
#include "meshing/regions.hpp"

namespace planum {

/// What is beyond the rim of the mesh, beside regions and Regions::rest.
inline constexpr std::uint32_t outside_mesh = Regions::rest - 1;

/// A line of edges between two junctions, or a closed one, with one label on its left and another
/// on its right all along.
struct BorderChain {
  std::uint32_t left = 0, right = 0;  ///< left is a region; right a higher region, rest, outside
  std::vector<std::uint32_t> half_edges;  ///< of the triangles on the left, in order
  bool closed = false;
};

/// The label across a half-edge.
std::uint32_t label_across(const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                           std::uint32_t half_edge);

/// The half-edge that follows a border half-edge on the border of the same label.
std::uint32_t next_on_border(const HalfEdges& edges, const std::vector<std::uint32_t>& labels,
                             std::uint32_t half_edge);

/// For each vertex, how many border lines end there: 2 along a line, other numbers at junctions.
std::vector<std::uint8_t> border_degrees(const HalfEdges& edges,
                                         const std::vector<std::uint32_t>& labels);

/// All chains of the regions' borders: line following on the half-edge mesh.
std::vector<BorderChain> border_chains(const HalfEdges& edges,
                                       const std::vector<std::uint32_t>& labels);

/// A chain as part of a ring: backwards where the region of the ring is on its right.
struct ChainUse {
  std::uint32_t chain = 0;
  bool reversed = false;
};

/// A closed border of a region, with the region on its left.
struct BorderRing {
  std::uint32_t triangle = 0;  ///< one of the region, beside the border
  std::vector<ChainUse> chains;
};

/// All rings of all regions.
std::vector<BorderRing> border_rings(const HalfEdges& edges,
                                     const std::vector<std::uint32_t>& labels,
                                     const std::vector<BorderChain>& chains);

}  // namespace planum
