#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "slam/core/triangle_mesh.hpp"

namespace planum::testing {

/// The point of a triangle that is nearest to p (Ericson, Real-Time Collision Detection, 5.1.5).
inline Eigen::Vector3d nearest_in_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                           const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const auto on_edge = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d edge = to - from;
    const double length = edge.squaredNorm();
    const double at = length > 0 ? std::clamp(edge.dot(p - from) / length, 0.0, 1.0) : 0.0;
    return Eigen::Vector3d(from + at * edge);
  };
  const Eigen::Vector3d normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  if (area > 0) {
    const Eigen::Vector3d q = p - normal.dot(p - a) / area * normal;
    const double v = (q - a).cross(ac).dot(normal) / area, w = ab.cross(q - a).dot(normal) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return q;
  }
  Eigen::Vector3d best = on_edge(a, b);
  for (const Eigen::Vector3d& other : {on_edge(b, c), on_edge(c, a)})
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  return best;
}

/// m, ascending: how far random places on one surface, evenly spread, are from the other.
inline std::vector<double> surface_distances(const TriangleMesh& from, const TriangleMesh& to,
                                             std::size_t samples) {
  const auto corner = [](const TriangleMesh& mesh, std::size_t triangle, std::size_t k) {
    return Eigen::Vector3d(mesh.vertices[mesh.triangles[triangle][k]].cast<double>());
  };
  std::vector<double> areas;
  for (std::size_t t = 0; t < from.triangles.size(); ++t)
    areas.push_back((corner(from, t, 1) - corner(from, t, 0))
                        .cross(corner(from, t, 2) - corner(from, t, 0))
                        .norm());
  std::mt19937 random(1);
  std::discrete_distribution<std::size_t> triangle(areas.begin(), areas.end());
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> distances;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::size_t t = triangle(random);
    double u = share(random), v = share(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Eigen::Vector3d p = corner(from, t, 0) + u * (corner(from, t, 1) - corner(from, t, 0)) +
                              v * (corner(from, t, 2) - corner(from, t, 0));
    double squared = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < to.triangles.size(); ++k)
      squared = std::min(
          squared,
          (nearest_in_triangle(p, corner(to, k, 0), corner(to, k, 1), corner(to, k, 2)) - p)
              .squaredNorm());
    distances.push_back(std::sqrt(squared));
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

}  // namespace planum::testing
