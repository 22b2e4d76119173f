#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "meshing/face_geometry.hpp"
#include "meshing/half_edge.hpp"

namespace planum {

/// Normals with less noise than those of single triangles, and where the mesh is flat.
struct SmoothedFaces {
  std::vector<Eigen::Vector3d> normal;        ///< unit, mean over the triangles around
  std::vector<Eigen::Vector3d> broad_normal;  ///< unit, mean over two rings of triangles around
  std::vector<Eigen::Vector3d> broad_centre;  ///< m, centroid of these rings
  std::vector<double> spread;                 ///< rad, rms of the normals in these rings
};

/// Triangles above `exact_area` (m^2) are taken as they are: noise turns only small ones.
SmoothedFaces smoothed_faces(const HalfEdges& edges, const FaceGeometry& faces, double exact_area);

/// The triangles with a spread below the limit (rad), flattest first.
std::vector<std::uint32_t> seeds(const SmoothedFaces& smooth, double max_spread);

}  // namespace planum
