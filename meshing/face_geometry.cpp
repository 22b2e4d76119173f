#include "meshing/face_geometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "slam/core/parallel.hpp"

namespace planum {

FaceGeometry face_geometry(const TriangleMesh& mesh) {
  FaceGeometry faces;
  const std::size_t count = mesh.triangles.size();
  faces.normal.resize(count);
  faces.centroid.resize(count);
  faces.area.resize(count);
  parallel_for(count, 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const auto& t = mesh.triangles[f];
      const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
      const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
      const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
      const Eigen::Vector3d n = (b - a).cross(c - a);
      const double length = n.norm();
      faces.centroid[f] = (a + b + c) / 3;
      faces.area[f] = length / 2;
      faces.normal[f] = length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
    }
  });
  return faces;
}

void add_triangle(PointMoments& moments, const TriangleMesh& mesh, std::uint32_t triangle,
                  double weight, const Eigen::Vector3d& origin) {
  // Three points of a twelfth of the weight at the corners and the rest at the centroid have the
  // same first and second moments as the surface.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : mesh.triangles[triangle]) {
    const Eigen::Vector3d p = mesh.vertices[v].cast<double>() - origin;
    sum += p;
    moments.add(p, weight / 12);
  }
  moments.add(sum / 3, weight * 0.75);
}

double rms_distance(const PointMoments& moments, const Plane& plane) {
  const Eigen::Vector3d& n = plane.normal;
  const double variance = n.dot(moments.covariance() * n);
  const double offset = n.dot(moments.centroid()) - plane.offset;
  return std::sqrt(std::max(0.0, variance) + offset * offset);
}

Plane relative_to(const Plane& plane, const Eigen::Vector3d& origin) {
  return {plane.normal, plane.offset - plane.normal.dot(origin)};
}

}  // namespace planum
