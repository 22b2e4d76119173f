#include "meshing/loose_parts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

namespace planum {
namespace {

/// Which vertices hang together (union-find, the lowest vertex stands for all).
class Parts {
 public:
  explicit Parts(const TriangleMesh& mesh) : parent_(mesh.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (const auto& [a, b, c] : mesh.triangles) {
      join(a, b);
      join(b, c);
    }
  }

  std::uint32_t of(std::uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<std::uint32_t> parent_;
};

double area(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                        &c = mesh.vertices[t[2]];
  return 0.5 * static_cast<double>((b - a).cross(c - a).norm());
}

}  // namespace

TriangleMesh without_loose_parts(const TriangleMesh& mesh, double min_area) {
  Parts parts(mesh);
  std::vector<double> areas(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) areas[parts.of(t[0])] += area(mesh, t);
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> name(mesh.vertices.size(), none);
  std::vector<bool> is_used(mesh.vertices.size(), false);
  TriangleMesh result;
  for (const auto& t : mesh.triangles) {
    if (areas[parts.of(t[0])] < min_area) continue;
    for (const std::uint32_t v : t) is_used[v] = true;
    result.triangles.push_back(t);
  }
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_used[v]) continue;
    name[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
  }
  for (auto& t : result.triangles)
    for (std::uint32_t& v : t) v = name[v];
  return result;
}

}  // namespace planum
