#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <unordered_map>
#include <vector>

#include <Eigen/Geometry>

#include "slam/core/pose.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum::testing {

/// Signed distance (m), positive in free space; NaN where nothing is known.
using Field = std::function<double(const Eigen::Vector3d&)>;

/// The surface where a field is zero, by marching tetrahedra on a grid over a box. Triangles are
/// counter-clockwise seen from free space; vertices are shared.
class MarchingTetrahedra {
 public:
  static TriangleMesh surface(const Field& field, const Eigen::Vector3d& low,
                              const Eigen::Vector3d& high, double cell) {
    MarchingTetrahedra marching(field, low, high, cell);
    marching.run();
    return std::move(marching.mesh_);
  }

 private:
  MarchingTetrahedra(const Field& field, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                     double cell)
      : low_(low), cell_(cell) {
    for (int k = 0; k < 3; ++k)
      size_[k] = static_cast<std::uint64_t>(std::ceil((high[k] - low[k]) / cell)) + 1;
    values_.resize(size_[0] * size_[1] * size_[2]);
    for (std::uint64_t i = 0; i < values_.size(); ++i) {
      values_[i] = field(corner(i));
      if (values_[i] == 0) values_[i] = 1e-9;
    }
  }

  Eigen::Vector3d corner(std::uint64_t i) const {
    return low_ + cell_ * Eigen::Vector3d(static_cast<double>(i % size_[0]),
                                          static_cast<double>(i / size_[0] % size_[1]),
                                          static_cast<double>(i / size_[0] / size_[1]));
  }

  void run() {
    for (std::uint64_t z = 0; z + 1 < size_[2]; ++z)
      for (std::uint64_t y = 0; y + 1 < size_[1]; ++y)
        for (std::uint64_t x = 0; x + 1 < size_[0]; ++x) cube(x, y, z);
  }

  void cube(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    std::array<std::uint64_t, 8> c;
    bool below = false, above = false;
    for (std::uint64_t k = 0; k < 8; ++k) {
      c[k] = ((z + (k >> 2)) * size_[1] + y + (k >> 1 & 1)) * size_[0] + x + (k & 1);
      if (std::isnan(values_[c[k]])) return;
      (values_[c[k]] < 0 ? below : above) = true;
    }
    if (!below || !above) return;
    // Six tetrahedra around the diagonal from corner 0 to 7.
    static constexpr int ring[6] = {1, 3, 2, 6, 4, 5};
    for (int k = 0; k < 6; ++k)
      tetrahedron({c[0], c[static_cast<std::size_t>(ring[k])],
                   c[static_cast<std::size_t>(ring[(k + 1) % 6])], c[7]});
  }

  void tetrahedron(const std::array<std::uint64_t, 4>& c) {
    std::vector<std::uint64_t> in, out;
    for (const std::uint64_t i : c) (values_[i] < 0 ? in : out).push_back(i);
    if (in.empty() || out.empty()) return;
    const Eigen::Vector3d free_side = corner(out[0]) - corner(in[0]);
    if (in.size() == 2) {
      const std::uint32_t a = vertex(in[0], out[0]), b = vertex(in[0], out[1]),
                          d = vertex(in[1], out[1]), e = vertex(in[1], out[0]);
      triangle(a, b, d, free_side);
      triangle(a, d, e, free_side);
      return;
    }
    const std::uint64_t apex = in.size() == 1 ? in[0] : out[0];
    const auto& base = in.size() == 1 ? out : in;
    triangle(vertex(apex, base[0]), vertex(apex, base[1]), vertex(apex, base[2]), free_side);
  }

  std::uint32_t vertex(std::uint64_t a, std::uint64_t b) {
    if (a > b) std::swap(a, b);
    const auto [at, is_new] = vertices_.try_emplace(
        a * values_.size() + b, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) {
      const double t = values_[a] / (values_[a] - values_[b]);
      mesh_.vertices.push_back((corner(a) + t * (corner(b) - corner(a))).cast<float>());
    }
    return at->second;
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c,
                const Eigen::Vector3d& free_side) {
    const Eigen::Vector3d pa = mesh_.vertices[a].cast<double>(),
                          pb = mesh_.vertices[b].cast<double>(),
                          pc = mesh_.vertices[c].cast<double>();
    if ((pb - pa).cross(pc - pa).dot(free_side) < 0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
  }

  Eigen::Vector3d low_;
  double cell_;
  std::array<std::uint64_t, 3> size_;
  std::vector<double> values_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  TriangleMesh mesh_;
};

/// Distance to the surface of a box, positive inside it.
inline double inside_box(const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high) {
  const Eigen::Vector3d beyond = (low - p).cwiseMax(p - high);
  return -(beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff()));
}

/// Moves every vertex by Gaussian noise (m).
inline void add_noise(TriangleMesh& mesh, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, static_cast<float>(sigma));
  for (Eigen::Vector3f& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] += noise(random);
}

inline TriangleMesh moved(TriangleMesh mesh, const Pose& b_from_a) {
  for (Eigen::Vector3f& v : mesh.vertices) v = (b_from_a * v.cast<double>()).cast<float>();
  return mesh;
}

}  // namespace planum::testing
