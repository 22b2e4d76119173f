#pragma once

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// The mesh without its parts of less area than this (m^2), and without vertices that no triangle
/// uses; what is left keeps its order. Parts hang together by vertices.
TriangleMesh without_loose_parts(const TriangleMesh& mesh, double min_area);

}  // namespace planum
