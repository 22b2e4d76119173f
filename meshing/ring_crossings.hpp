#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// Two edges that cross or touch: edge i of a ring joins its vertices i and i + 1.
struct RingCrossing {
  std::size_t first_ring, first_edge, second_ring, second_edge;
};

/// All crossings of the edges of some rings. Edges with a vertex in common do not count: rings may
/// touch at a vertex.
std::vector<RingCrossing> ring_crossings(std::span<const Ring> rings,
                                         std::span<const Ring2d> positions);

}  // namespace planum
