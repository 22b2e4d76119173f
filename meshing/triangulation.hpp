#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "meshing/polygon_map.hpp"

namespace planum {

/// A polygon map as triangles.
struct TriangulatedMap {
  static constexpr std::uint32_t rest = std::numeric_limits<std::uint32_t>::max();

  TriangleMesh mesh;                   ///< counter-clockwise seen from free space
  std::vector<std::uint32_t> polygon;  ///< for each triangle its polygon, or `rest`
  std::vector<std::uint8_t> inferred;  ///< for each triangle whether it fills a laser shadow
};

/// Triangles of all polygons, then the rest, then what is inferred. Polygons are divided by
/// constrained Delaunay triangulation without new vertices; neighbours keep their common vertices,
/// and so does the rest. The area of a polygon is that of its triangles that are not inferred.
TriangulatedMap triangulated(const PolygonMap& map);

}  // namespace planum
