#pragma once

#include <cstdint>
#include <vector>

#include "meshing/face_geometry.hpp"
#include "meshing/half_edge.hpp"
#include "meshing/regions.hpp"

namespace planum {

struct CreaseParams {
  double reach = 0.05;             ///< m, triangles this near to a plane may join its region
  double max_angle = radians(75);  ///< between a plane and the normal of a triangle that joins
  double min_component = 0.02;     ///< m^2, smaller islands of a region join their surroundings
};

/// For each triangle the region it goes to, or Regions::rest: the regions with the chamfers along
/// their creases, which marching cubes cut into every edge, given to the nearer plane, so that
/// regions meet directly; small islands and dents inside a plane are given to it, and teeth along
/// the borders are cut.
std::vector<std::uint32_t> closed_creases(const Regions& regions, const HalfEdges& edges,
                                          const FaceGeometry& faces, const CreaseParams& params);

}  // namespace planum
