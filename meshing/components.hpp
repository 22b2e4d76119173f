#pragma once

#include <cstdint>
#include <vector>

#include "meshing/half_edge.hpp"

namespace planum {

/// Triangles with the same label that hang together by edges.
struct Components {
  std::vector<std::uint32_t> of_triangle;             ///< none for degenerate triangles
  std::vector<std::vector<std::uint32_t>> triangles;  ///< of each component
};

Components components(const HalfEdges& edges, const std::vector<std::uint32_t>& labels);

}  // namespace planum
