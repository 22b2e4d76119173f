#include "slam/evaluation/surface_tree.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/mesh_corners.hpp"

namespace planum {
namespace {

constexpr std::uint32_t triangles_of_leaf = 4;

Eigen::Vector3d nearest_on_edge(const Eigen::Vector3d& p, const Eigen::Vector3d& from,
                                const Eigen::Vector3d& to) {
  const Eigen::Vector3d edge = to - from;
  const double squared = edge.squaredNorm();
  const double share = squared > 0 ? std::clamp(edge.dot(p - from) / squared, 0.0, 1.0) : 0.0;
  return from + share * edge;
}

/// Within the triangle if the foot of the perpendicular is, else on the nearest edge.
Eigen::Vector3d nearest_in_triangle(const Eigen::Vector3d& p, const Corners& c) {
  const Eigen::Vector3d u = c[1] - c[0], v = c[2] - c[0], n = u.cross(v);
  const double squared = n.squaredNorm();
  if (squared > 0) {
    const Eigen::Vector3d w = p - c[0];
    // Barycentric coordinates of the foot.
    const double beta = w.cross(v).dot(n) / squared, gamma = u.cross(w).dot(n) / squared;
    if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) return c[0] + beta * u + gamma * v;
  }
  Eigen::Vector3d best = nearest_on_edge(p, c[0], c[1]);
  for (const auto& [from, to] : {std::pair(c[1], c[2]), std::pair(c[2], c[0])}) {
    const Eigen::Vector3d other = nearest_on_edge(p, from, to);
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  }
  return best;
}

}  // namespace

void check_mesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw Error(fmt::format("evaluation: vertex {} of the mesh is not finite", i));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      if (vertex >= mesh.vertices.size())
        throw Error(fmt::format("evaluation: triangle {} names vertex {}, but there are {}", t,
                                vertex, mesh.vertices.size()));
}

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : mesh_(mesh) {
  check_mesh(mesh);
  if (mesh.triangles.empty()) throw Error("evaluation: the mesh has no triangle");
  std::vector<Item> items(mesh.triangles.size());
  for (std::uint32_t t = 0; t < items.size(); ++t) {
    for (const Eigen::Vector3d& corner : corners_of(mesh, t)) items[t].box.extend(corner);
    items[t].centre = items[t].box.center();
  }
  order_.resize(items.size());
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.resize(1);
  build(0, 0, static_cast<std::uint32_t>(order_.size()), items);
}

void SurfaceTree::build(std::size_t node, std::uint32_t begin, std::uint32_t end,
                        const std::vector<Item>& items) {
  Eigen::AlignedBox3d centres;
  for (std::uint32_t k = begin; k < end; ++k) {
    nodes_[node].box.extend(items[order_[k]].box);
    centres.extend(items[order_[k]].centre);
  }
  if (end - begin <= triangles_of_leaf) {
    // In the order of the mesh, so that the lowest of several is found first.
    std::sort(order_.begin() + begin, order_.begin() + end);
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  Eigen::Index axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = items[a].centre[axis], y = items[b].centre[axis];
                     return x != y ? x < y : a < b;
                   });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = children;
  nodes_.resize(nodes_.size() + 2);
  build(children, begin, middle, items);
  build(children + 1, middle, end, items);
}

std::optional<SurfacePoint> SurfaceTree::nearest(const Eigen::Vector3d& query,
                                                 double max_distance) const {
  std::optional<SurfacePoint> best;
  double squared_bound = max_distance * max_distance;
  const auto look_at = [&](const Node& leaf) {
    for (std::uint32_t k = leaf.first; k < leaf.first + leaf.count; ++k) {
      const std::uint32_t triangle = order_[k];
      const Eigen::Vector3d point = nearest_in_triangle(query, corners_of(mesh_, triangle));
      const double squared = (point - query).squaredNorm();
      if (squared > squared_bound ||
          (best && squared == squared_bound && triangle > best->triangle))
        continue;
      squared_bound = squared;
      best = SurfacePoint{point, 0, triangle};
    }
  };
  std::vector<std::pair<double, std::uint32_t>> pending = {
      {nodes_[0].box.squaredExteriorDistance(query), 0}};
  while (!pending.empty()) {
    const auto [distance, at] = pending.back();
    pending.pop_back();
    if (distance > squared_bound) continue;
    const Node& node = nodes_[at];
    if (node.count > 0) {
      look_at(node);
      continue;
    }
    std::pair<double, std::uint32_t> near = {nodes_[node.first].box.squaredExteriorDistance(query),
                                             node.first};
    std::pair<double, std::uint32_t> far = {
        nodes_[node.first + 1].box.squaredExteriorDistance(query), node.first + 1};
    if (far.first < near.first) std::swap(near, far);
    pending.push_back(far);
    pending.push_back(near);
  }
  if (best) best->distance = std::sqrt(squared_bound);
  return best;
}

Eigen::Vector3d SurfaceTree::normal(std::uint32_t triangle) const {
  const Corners c = corners_of(mesh_, triangle);
  return (c[1] - c[0]).cross(c[2] - c[0]).normalized();
}

}  // namespace planum
