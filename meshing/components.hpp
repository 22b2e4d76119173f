#pragma once

#include <cstdint>
#include <vector>

#include "meshing/half_edge.hpp"

namespace planum {

/// Triangles with the same label that hang together by edges.
struct MeshComponents {
  std::vector<std::uint32_t> of_triangle;             ///< none for degenerate triangles
  std::vector<std::vector<std::uint32_t>> triangles;  ///< of each component
};

MeshComponents components(const HalfEdges& edges, const std::vector<std::uint32_t>& labels);

}  // namespace planum
