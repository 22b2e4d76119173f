#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshing/plane_geometry.hpp"

namespace planum {

/// Whether rings, an outer one and its holes, are a valid polygon (OGC): no ring crosses itself or
/// another, holes are inside. By GEOS.
bool is_valid_polygon(std::span<const Ring2d> rings);

/// Triangles of a polygon with holes by GEOS's constrained Delaunay triangulation: indices into the
/// vertices of all rings, one ring after the other, counter-clockwise. Empty if GEOS fails or
/// brings in vertices that are not ours.
std::optional<std::vector<std::array<std::uint32_t, 3>>> constrained_delaunay(
    std::span<const Ring2d> rings);

/// What rings cover, as valid polygons (outer ring and holes each), by GEOS. Where edges cross
/// there are new vertices.
std::vector<std::vector<Ring2d>> made_valid(std::span<const Ring2d> rings);

}  // namespace planum
