#pragma once

#include <vector>

#include "meshing/half_edge.hpp"
#include "meshing/polygon_map.hpp"
#include "meshing/triangulation.hpp"
#include "tests/meshing/synthetic_mesh.hpp"

namespace planum::testing {

using Eigen::Vector3d;

/// Free space of a room with low corner 0.
inline Field box_room(const Vector3d& size) {
  return [size](const Vector3d& p) { return inside_box(p, Vector3d::Zero(), size); };
}

inline TriangleMesh box_room_mesh(const Vector3d& size, double cell) {
  const Vector3d margin = Vector3d::Constant(2.37 * cell);
  return MarchingTetrahedra::surface(box_room(size), -margin, size + margin, cell);
}

/// Two rooms of 3 x 3 x 2.4 m with a wall of 0.2 m and a door of 0.9 x 2 m between them.
inline Field two_rooms() {
  return [](const Vector3d& p) {
    const double rooms =
        std::max(inside_box(p, {0, 0, 0}, {3, 3, 2.4}), inside_box(p, {3.2, 0, 0}, {6.2, 3, 2.4}));
    return std::max(rooms, inside_box(p, {2.5, 1, 0}, {3.7, 1.9, 2}));
  };
}

inline TriangleMesh two_rooms_mesh(double cell) {
  const Vector3d margin = Vector3d::Constant(2.37 * cell);
  return MarchingTetrahedra::surface(two_rooms(), -margin, Vector3d(6.2, 3, 2.4) + margin, cell);
}

/// A room of 4 x 4 x 2.4 m with a round column and a box on the floor.
inline Field furnished_room() {
  return [](const Vector3d& p) {
    const double column = std::hypot(p.x() - 1, p.y() - 1) - 0.22;
    const double box = -inside_box(p, {2, 2, -1}, {3, 3.2, 0.75});
    return std::min({inside_box(p, {0, 0, 0}, {4, 4, 2.4}), column, box});
  };
}

inline TriangleMesh furnished_room_mesh(double cell) {
  const Vector3d margin = Vector3d::Constant(2.37 * cell);
  return MarchingTetrahedra::surface(furnished_room(), -margin, Vector3d(4, 4, 2.4) + margin, cell);
}

/// A floor with a step of `height`, between walls; the step runs along x = 2.
inline TriangleMesh step_mesh(double height, double cell) {
  const Field field = [height](const Vector3d& p) {
    return std::max(inside_box(p, {0, 0, 0}, {4, 3, 2.4}),
                    inside_box(p, {2, 0, -height}, {4, 3, 2.4}));
  };
  const Vector3d margin = Vector3d::Constant(2.37 * cell);
  return MarchingTetrahedra::surface(field, Vector3d(0, 0, -height) - margin,
                                     Vector3d(4, 3, 2.4) + margin, cell);
}

inline Pose some_pose(double angle) {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(angle, Vector3d(0.3, -0.5, 0.8).normalized()));
  pose.pretranslate(Vector3d(12, -7, 3));
  return pose;
}

/// Edges of a mesh that are not there once in each direction.
inline std::size_t open_edges(const TriangleMesh& mesh) {
  const HalfEdges edges = half_edges(mesh);
  std::size_t open = edges.complex_edges;
  for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
    open += !edges.is_degenerate(h / 3) && edges.opposite[h] == HalfEdges::none;
  return open;
}

inline double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                   c = mesh.vertices[t[2]].cast<double>();
    sum += (b - a).cross(c - a).norm() / 2;
  }
  return sum;
}

/// Of a closed mesh; positive where normals look into free space inside it would be negative.
inline double signed_volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].cast<double>().dot(
               mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>())) /
           6;
  return sum;
}

}  // namespace planum::testing
