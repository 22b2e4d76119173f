#pragma once

#include "meshing/polygon_map.hpp"
#include "meshing/regions.hpp"

namespace planum {

struct PolygonParams {
  double max_error = 0.025;  ///< m, of simplified borders where they are not the edge of two planes
  double max_move = 0.1;     ///< m, vertices go no farther to the edge or corner of their planes
  double crease_reach = 0.05;   ///< m, triangles this near to a plane may join it to close a crease
  double max_gap = 0.13;        ///< m, narrower cracks and notches in the surface are closed
  double min_component = 0.02;  ///< m^2, smaller islands of a region join what is around them
  double rest_error = 0.01;  ///< m, of what is in no plane, where few triangles do for many; 0: all
                             ///< triangles stay
  double min_hole = 0.02;    ///< m^2, smaller holes in the surface inside a plane are closed
};

/// Parameters that suit a mesh with cells of this size (m).
PolygonParams polygon_params(double cell);

/// The borders of regions as polygons with holes. The chamfers that marching cubes cut into creases
/// go to the planes beside them; every vertex between regions moves to where their planes meet;
/// borders between junctions are simplified once for both sides, so that neighbours share vertices.
/// Each polygon is plane within half a millimetre, simple, and counter-clockwise seen from free
/// space. Planes that do not meet near their common border get one each, with triangles in `rest`
/// between them; the triangles that are in no region are there too, fewer where they are small
/// beside what they bend (reduced_surface). Throws Error for parameters out of range and for
/// regions of another mesh.
PolygonMap polygonize(const TriangleMesh& mesh, const Regions& regions,
                      const PolygonParams& params = {});

}  // namespace planum
