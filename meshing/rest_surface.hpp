#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meshing/chain_shapes.hpp"
#include "meshing/corner_snapping.hpp"

namespace planum {

/// The surface between polygons: triangles that are in no region, with the borders they share moved
/// as the polygons' were. Corners name points of `points`.
struct RestSurface {
  std::vector<Eigen::Vector3d> points;  ///< the snapped points first, then vertices of the rest
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Triangles of the rest, then those that close steps between planes along chains and at corners.
/// Vertices that a simplified border dropped are merged into those it kept, unless that would fold
/// a triangle: such vertices are added to `kept` of their chain again, on the straight line.
RestSurface rest_surface(const TriangleMesh& mesh, const HalfEdges& edges,
                         const std::vector<std::uint32_t>& labels, const SnappedCorners& corners,
                         std::vector<ChainShape>& shapes);

}  // namespace planum
