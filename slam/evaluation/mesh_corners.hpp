#pragma once

#include <array>
#include <cstdint>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

using Corners = std::array<Eigen::Vector3d, 3>;

inline Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
          mesh.vertices[c].cast<double>()};
}

/// Throws Error if a triangle names a vertex that is not there, or a vertex is not finite.
void check_mesh(const TriangleMesh& mesh);

}  // namespace planum
