#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/core/plane.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Normal, area and centroid of every triangle of a mesh.
struct FaceGeometry {
  std::vector<Eigen::Vector3d> normal;    ///< unit; zero where the area is zero
  std::vector<Eigen::Vector3d> centroid;  ///< m
  std::vector<double> area;               ///< m^2
};

FaceGeometry face_geometry(const TriangleMesh& mesh);

/// Adds the whole surface of a triangle, relative to `origin`, with its weight spread evenly.
void add_triangle(PointMoments& moments, const TriangleMesh& mesh, std::uint32_t triangle,
                  double weight, const Eigen::Vector3d& origin);

/// Root mean squared distance (m) of what the moments were taken of from a plane; both relative to
/// the same origin.
double rms_distance(const PointMoments& moments, const Plane& plane);

/// The same plane where the origin of coordinates is moved to `origin`, and back.
Plane relative_to(const Plane& plane, const Eigen::Vector3d& origin);

}  // namespace planum
