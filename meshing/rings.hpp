#pragma once

#include <cstdint>
#include <vector>

#include "meshing/polygon_map.hpp"

namespace planum {

/// A ring of vertices that may touch itself, as rings that visit each vertex once: repeated
/// neighbours and spikes (a b a) go, a ring that comes back to a vertex is cut in two there. Rings
/// of fewer than three vertices are dropped.
std::vector<Ring> simple_rings(const Ring& ring);

}  // namespace planum
