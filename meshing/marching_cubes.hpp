#pragma once

#include "meshing/distance_field.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// The surface where the distance is zero (Lorensen and Cline 1987), as triangles with shared
/// vertices, counter-clockwise seen from where distances are positive.
///
/// Only cells whose eight corners are known have a surface, and only where the distance grows along
/// the normals: a change of sign halfway between two sheets is no surface. Faces with two ways to
/// join them are decided the same way by both cells, so that there are no cracks; no edge has more
/// than two triangles.
TriangleMesh marching_cubes(const DistanceField& field);

}  // namespace planum
