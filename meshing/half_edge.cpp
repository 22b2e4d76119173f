#include "meshing/half_edge.hpp"

#include <algorithm>
#include <string>

#include <Eigen/Geometry>

#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw Error("mesh: vertex " + std::to_string(i) + " is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v >= mesh.vertices.size())
        throw Error("mesh: triangle " + std::to_string(i) + " names vertex " + std::to_string(v) +
                    " of " + std::to_string(mesh.vertices.size()));
}

/// Half-edges sorted by the lower of their two vertices: all of one edge lie in one bucket.
struct Buckets {
  std::vector<std::uint32_t> begin, half_edges;
};

Buckets sorted_by_lower_vertex(const HalfEdges& edges, std::size_t vertices) {
  Buckets buckets;
  buckets.begin.assign(vertices + 1, 0);
  const auto faces = static_cast<std::uint32_t>(edges.triangles.size());
  const auto each = [&](auto&& visit) {
    for (std::uint32_t f = 0; f < faces; ++f) {
      if (edges.is_degenerate(f)) continue;
      const auto& t = edges.triangles[f];
      for (std::uint32_t k = 0; k < 3; ++k) visit(3 * f + k, std::min(t[k], t[(k + 1) % 3]));
    }
  };
  each([&](std::uint32_t, std::uint32_t low) { ++buckets.begin[low + 1]; });
  for (std::size_t v = 0; v < vertices; ++v) buckets.begin[v + 1] += buckets.begin[v];
  buckets.half_edges.resize(buckets.begin[vertices]);
  std::vector<std::uint32_t> at(buckets.begin.begin(), buckets.begin.end() - 1);
  each([&](std::uint32_t h, std::uint32_t low) { buckets.half_edges[at[low]++] = h; });
  return buckets;
}

Eigen::Vector3f unit_normal(const TriangleMesh& mesh, std::uint32_t face) {
  const auto& t = mesh.triangles[face];
  const Eigen::Vector3f n =
      (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
  const float length = n.norm();
  return length > 0 ? Eigen::Vector3f(n / length) : Eigen::Vector3f::Zero();
}

void join(HalfEdges& edges, std::uint32_t a, std::uint32_t b) {
  edges.opposite[a] = b;
  edges.opposite[b] = a;
}

/// Pairs the half-edges of an edge with other than two triangles: flattest pairs first.
void pair_flattest(HalfEdges& edges, const TriangleMesh& mesh,
                   std::span<const std::uint32_t> group) {
  for (;;) {
    float best = -2;
    std::uint32_t first = HalfEdges::none, second = HalfEdges::none;
    for (const std::uint32_t a : group)
      for (const std::uint32_t b : group) {
        if (edges.opposite[a] != HalfEdges::none || edges.opposite[b] != HalfEdges::none) continue;
        if (edges.from(a) > edges.to(a) || edges.from(b) < edges.to(b)) continue;
        const float fit = unit_normal(mesh, a / 3).dot(unit_normal(mesh, b / 3));
        if (fit > best) {
          best = fit;
          first = a;
          second = b;
        }
      }
    if (first == HalfEdges::none) return;
    join(edges, first, second);
  }
}

/// Pairs the half-edges of an edge in the order of their triangles.
void pair_in_order(HalfEdges& edges, std::span<const std::uint32_t> group) {
  std::vector<std::uint32_t> up, down;
  for (const std::uint32_t h : group) (edges.from(h) < edges.to(h) ? up : down).push_back(h);
  for (std::size_t i = 0; i < std::min(up.size(), down.size()); ++i) join(edges, up[i], down[i]);
}

void pair_complex_edge(HalfEdges& edges, const TriangleMesh& mesh,
                       std::span<const std::uint32_t> group) {
  ++edges.complex_edges;
  // Comparing all with all takes too long where a broken mesh has hundreds of triangles at an edge.
  if (group.size() <= 16)
    pair_flattest(edges, mesh, group);
  else
    pair_in_order(edges, group);
}

void pair_edges(HalfEdges& edges, const TriangleMesh& mesh) {
  Buckets buckets = sorted_by_lower_vertex(edges, mesh.vertices.size());
  const auto high = [&](std::uint32_t h) { return std::max(edges.from(h), edges.to(h)); };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto begin = buckets.half_edges.begin() + buckets.begin[v];
    const auto end = buckets.half_edges.begin() + buckets.begin[v + 1];
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      return high(a) != high(b) ? high(a) < high(b) : a < b;
    });
    for (auto i = begin; i != end;) {
      auto j = i + 1;
      while (j != end && high(*j) == high(*i)) ++j;
      const auto count = j - i;
      if (count == 2 && edges.from(*i) == edges.to(*(i + 1)))
        join(edges, *i, *(i + 1));
      else if (count > 1)
        pair_complex_edge(edges, mesh, {&*i, static_cast<std::size_t>(count)});
      i = j;
    }
  }
}

/// Gives each fan of triangles around a vertex a vertex of its own.
void split_fans(HalfEdges& edges, std::size_t vertices) {
  std::vector<bool> seen_corner(edges.opposite.size(), false), used(vertices, false);
  const std::vector<std::array<std::uint32_t, 3>> original = edges.triangles;
  for (std::uint32_t corner = 0; corner < edges.opposite.size(); ++corner) {
    if (seen_corner[corner] || edges.is_degenerate(corner / 3)) continue;
    const std::uint32_t v = original[corner / 3][corner % 3];
    std::uint32_t name = v;
    if (used[v]) {
      name = static_cast<std::uint32_t>(edges.source.size());
      edges.source.push_back(v);
      ++edges.split_vertices;
    }
    used[v] = true;
    const auto visit = [&](std::uint32_t h) {
      seen_corner[h] = true;
      edges.triangles[h / 3][h % 3] = name;
    };
    // Counter-clockwise to the rim or all around; from the rim also the other way.
    std::uint32_t h = corner;
    do {
      visit(h);
      h = edges.opposite[HalfEdges::previous(h)];
    } while (h != HalfEdges::none && h != corner);
    if (h == corner) continue;
    for (h = edges.opposite[corner]; h != HalfEdges::none; h = edges.opposite[h]) {
      h = HalfEdges::next(h);
      visit(h);
    }
  }
}

}  // namespace

HalfEdges half_edges(const TriangleMesh& mesh) {
  check(mesh);
  HalfEdges edges;
  edges.triangles = mesh.triangles;
  edges.opposite.assign(3 * mesh.triangles.size(), HalfEdges::none);
  edges.source.resize(mesh.vertices.size());
  for (std::uint32_t v = 0; v < edges.source.size(); ++v) edges.source[v] = v;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    edges.degenerate += edges.is_degenerate(f);
  pair_edges(edges, mesh);
  split_fans(edges, mesh.vertices.size());
  return edges;
}

}  // namespace planum
