#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/plane_geometry.hpp"

namespace planum {

/// Triangles of a polygon with holes by clipping ears, the largest smallest angle first, after
/// holes are joined to the outer ring by bridges (Held 2001, without its hashing). Indices are into
/// the vertices of all rings, one ring after the other. The outer ring is counter-clockwise, holes
/// are clockwise. Always ends: where rings cross each other the result overlaps.
std::vector<std::array<std::uint32_t, 3>> clipped_ears(std::span<const Ring2d> rings);

}  // namespace planum
