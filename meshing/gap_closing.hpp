#pragma once

#include <cstddef>

#include "meshing/half_edge.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Closes small holes, cracks and notches: ears between two edges of the rim are filled with
/// triangles as long as the new edge is not longer than max_gap (m), the shortest first, so that
/// narrow cracks are zipped from their ends and staircases lose their notches. New triangles are
/// appended to the mesh and to its half-edges. Returns how many.
std::size_t close_gaps(TriangleMesh& mesh, HalfEdges& edges, double max_gap);

}  // namespace planum
