#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "slam/sensor/ray_caster.hpp"

namespace planum::testing {

/// Adds the parallelogram corner, corner + u, corner + u + v, corner + v.
inline void add_rectangle(TriangleMesh& mesh, const Eigen::Vector3d& corner,
                          const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& p : {corner, Eigen::Vector3d(corner + u),
                                   Eigen::Vector3d(corner + u + v), Eigen::Vector3d(corner + v)})
    mesh.vertices.push_back(p.cast<float>());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Adds the six sides of a box, counter-clockwise seen from outside.
inline void add_box(TriangleMesh& mesh, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d size = high - low;
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  add_rectangle(mesh, low, y, x);
  add_rectangle(mesh, low, x, z);
  add_rectangle(mesh, low, z, y);
  add_rectangle(mesh, high, -x, -y);
  add_rectangle(mesh, high, -z, -x);
  add_rectangle(mesh, high, -y, -z);
}

/// How the tilting laser of the tests measures.
struct ScannerParams {
  int beams = 361;  ///< over half a turn, in front
  int slices = 200;
  double lowest = -60;  ///< deg
  double highest = 60;  ///< deg
  double noise = 0.01;  ///< m, standard deviation along the beam
  unsigned seed = 1;
};

/// A registered cloud and what is true of it.
struct ScannedScene {
  Cloud cloud;
  std::vector<Eigen::Vector3d> origins;
  std::vector<Eigen::Vector3f> normals;  ///< of the surfaces that were hit, towards the scanner
};

/// Scans a model from poses (world_from_scanner: x forward, z up).
inline ScannedScene scanned(const TriangleMesh& model, const std::vector<Pose>& poses,
                            const ScannerParams& params = {}) {
  const RayCaster caster(model);
  std::mt19937 random(params.seed);
  std::normal_distribution<double> noise(0, params.noise);
  ScannedScene scene;
  for (std::size_t s = 0; s < poses.size(); ++s) {
    scene.origins.push_back(poses[s].translation());
    for (int slice = 0; slice < params.slices; ++slice)
      for (int beam = 0; beam < params.beams; ++beam) {
        const double tilt =
            radians(params.lowest + (params.highest - params.lowest) * slice / (params.slices - 1));
        const double azimuth = radians(-90 + 180.0 * beam / (params.beams - 1));
        const Eigen::Vector3d in_scanner = Eigen::AngleAxisd(-tilt, Eigen::Vector3d::UnitY()) *
                                           Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0);
        const Eigen::Vector3d direction = poses[s].linear() * in_scanner;
        const auto hit = caster.cast(poses[s].translation(), direction, 50);
        if (!hit) continue;
        const double range = hit->distance + (params.noise > 0 ? noise(random) : 0.0);
        scene.cloud.points.push_back((poses[s].translation() + range * direction).cast<float>());
        scene.cloud.scan.push_back(static_cast<std::uint32_t>(s));
        const bool ahead = hit->normal.dot(direction.cast<float>()) < 0;
        scene.normals.push_back(ahead ? hit->normal : Eigen::Vector3f(-hit->normal));
      }
  }
  return scene;
}

/// Looking along +x turned by yaw (deg) from a place.
inline Pose looking(const Eigen::Vector3d& from, double yaw) {
  return pose_from_xyz_ypr(from, radians(yaw), 0, 0);
}

/// A room of 5 x 4 x 2.5 m with a box in it, scanned from two places.
inline TriangleMesh room_with_box() {
  TriangleMesh model;
  add_box(model, {0, 0, 0}, {5, 4, 2.5});
  add_box(model, {3.02, 1.03, 0}, {3.71, 2.22, 0.77});
  return model;
}
inline std::vector<Pose> room_poses() {
  return {looking({0.6, 0.7, 0.9}, 40), looking({4.4, 3.3, 1.1}, -140),
          looking({0.7, 3.2, 1.0}, -50), looking({4.5, 0.5, 1.0}, 140)};
}

inline double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                               const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const auto to_segment = [&](const Eigen::Vector3d& s, const Eigen::Vector3d& e) {
    const double t = std::clamp((p - s).dot(e - s) / (e - s).squaredNorm(), 0.0, 1.0);
    return (s + t * (e - s) - p).squaredNorm();
  };
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const bool inside = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                      n.dot((a - c).cross(p - c)) >= 0;
  if (inside) return std::pow(n.dot(p - a), 2) / n.squaredNorm();
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

/// Distance of a point to the nearest triangle, by trying them all.
inline double distance_to(const TriangleMesh& mesh, const Eigen::Vector3f& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    best = std::min(best, squared_distance(p.cast<double>(), mesh.vertices[t[0]].cast<double>(),
                                           mesh.vertices[t[1]].cast<double>(),
                                           mesh.vertices[t[2]].cast<double>()));
  return std::sqrt(best);
}

/// What a mesh is like as a graph.
struct Topology {
  std::size_t boundary_edges = 0, crowded_edges = 0, twisted_edges = 0, components = 0;
};

/// Crowded: more than two triangles at an edge; twisted: two that run along it the same way.
inline Topology topology_of(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> uses;
  std::vector<std::uint32_t> root(mesh.vertices.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      auto& use = uses[{std::min(a, b), std::max(a, b)}];
      ++(a < b ? use.first : use.second);
      root[find(a)] = find(b);
    }
  Topology result;
  for (const auto& [edge, use] : uses) {
    const int count = use.first + use.second;
    result.boundary_edges += count == 1;
    result.crowded_edges += count > 2;
    result.twisted_edges += count == 2 && use.first != use.second;
  }
  std::vector<bool> seen(root.size(), false);
  for (const auto& t : mesh.triangles) {
    const std::uint32_t r = find(t[0]);
    result.components += !seen[r];
    seen[r] = true;
  }
  return result;
}

/// Volume inside a closed mesh; negative if its triangles face inwards.
inline double volume_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].cast<double>().dot(
        mesh.vertices[t[1]].cast<double>().cross(mesh.vertices[t[2]].cast<double>()));
  return sum / 6;
}

inline double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Eigen::Vector3f a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Eigen::Vector3f b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  return 0.5 * double(a.cross(b).norm());
}

}  // namespace planum::testing
