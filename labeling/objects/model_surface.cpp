#include "labeling/objects/model_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Corners = std::array<Eigen::Vector3f, 3>;

Corners corners(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

/// Whether a triangle is hit between two places (Moeller & Trumbore, Fast, minimum storage
/// ray-triangle intersection, 1997).
bool is_between(const Corners& triangle, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  const Eigen::Vector3f ray = to - from;
  const Eigen::Vector3f e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
  const Eigen::Vector3f h = ray.cross(e2), s = from - triangle[0];
  const float determinant = e1.dot(h);
  if (determinant == 0) return false;
  const float u = s.dot(h) / determinant;
  if (!(u >= 0 && u <= 1)) return false;
  const Eigen::Vector3f q = s.cross(e1);
  const float v = ray.dot(q) / determinant, t = e2.dot(q) / determinant;
  return v >= 0 && u + v <= 1 && t > 0 && t < 1;
}

}  // namespace

SurfaceSamples surface_samples(const TriangleMesh& mesh, double spacing) {
  // A sequence that fills the square evenly: multiples of the powers of the plastic number.
  constexpr double first_step = 0.7548776662466927, second_step = 0.5698402909980532;
  SurfaceSamples samples;
  double due = 0.5, u = 0.5, v = 0.5;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = corners(mesh, i);
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    for (due += normal.norm() / 2 / (spacing * spacing); due >= 1; due -= 1) {
      u = std::fmod(u + first_step, 1.0);
      v = std::fmod(v + second_step, 1.0);
      const auto s = static_cast<float>(u + v > 1 ? 1 - u : u);
      const auto t = static_cast<float>(u + v > 1 ? 1 - v : v);
      samples.points.push_back(a + s * (b - a) + t * (c - a));
      samples.normals.push_back(normal.normalized());
    }
  }
  return samples;
}

TriangleMesh scaled(const TriangleMesh& mesh, const Eigen::Vector3d& scale) {
  TriangleMesh result = mesh;
  for (Eigen::Vector3f& p : result.vertices) p = p.cwiseProduct(scale.cast<float>());
  return result;
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& p : mesh.vertices) box.extend(p.cast<double>());
  return box;
}

std::vector<bool> are_visible(const SurfaceSamples& samples, const TriangleMesh& mesh,
                              std::span<const Eigen::Vector3d> places) {
  const auto flattest = static_cast<float>(std::sin(radians(10)));
  constexpr float lift = 0.002f;  // m, off the triangle the sample lies on
  const auto sees = [&](const Eigen::Vector3f& place, const Eigen::Vector3f& p,
                        const Eigen::Vector3f& normal) {
    const Eigen::Vector3f ray = place - p;
    if (normal.dot(ray) < flattest * ray.norm()) return false;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      if (is_between(corners(mesh, i), p + lift * normal, place)) return false;
    return true;
  };
  std::vector<bool> visible(samples.points.size(), false);
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    visible[i] = std::any_of(places.begin(), places.end(), [&](const Eigen::Vector3d& place) {
      return sees(place.cast<float>(), samples.points[i], samples.normals[i]);
    });
  return visible;
}

}  // namespace planum
