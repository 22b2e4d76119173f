#pragma once

#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Which parts of a mesh are surface. Parts hang together by vertices.
struct LoosePartParams {
  double min_area = 0;     ///< m^2, parts smaller than this are specks
  double sure_area = 0;    ///< m^2, parts smaller than this have to show many points:
  double min_density = 0;  ///< 1/m^2, so many of them
  double cell = 0.05;      ///< m, points count for the parts that their cell of a grid holds
};

/// The mesh without specks, and without parts that so few points made that beams must have gone
/// through between them (a beam that grazes an edge returns a range from behind it, and a few such
/// points make a veil); without vertices that no triangle uses, too. What is left keeps its order.
///
/// Only points that have normals count. Throws Error if the cloud has none.
TriangleMesh without_loose_parts(const TriangleMesh& mesh, const Cloud& cloud,
                                 const LoosePartParams& params);

}  // namespace planum
