#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// The neighbourhood of a triangle mesh as flat arrays. Half-edge 3 f + k runs from corner k of
/// triangle f to its next corner. Nothing is lost where the mesh is not a manifold: more than two
/// triangles at an edge are paired by their normals, and a vertex where several fans of triangles
/// meet is split into one vertex a fan. (docs/polygons.md says why these are not OpenMesh's.)
struct HalfEdges {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< as in the mesh, with split vertices
  std::vector<std::uint32_t> opposite;  ///< the half-edge back, or none at the rim of the mesh
  std::vector<std::uint32_t> source;    ///< for each vertex, the vertex of the mesh it stands for
  std::size_t complex_edges = 0;        ///< edges that were not two triangles back to back
  std::size_t split_vertices = 0;       ///< vertices added to give each fan its own
  std::size_t degenerate = 0;  ///< triangles that name a vertex twice; no half-edge is theirs

  static std::uint32_t face(std::uint32_t half_edge) { return half_edge / 3; }
  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  std::uint32_t from(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
  std::uint32_t to(std::uint32_t h) const { return from(next(h)); }
  bool is_degenerate(std::uint32_t f) const {
    const auto& t = triangles[f];
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  }
};

/// Throws Error if a triangle names a vertex that is not there, or a vertex is not finite.
HalfEdges half_edges(const TriangleMesh& mesh);

}  // namespace planum
