#include "meshing/ring_crossings.hpp"

#include <algorithm>

namespace planum {
namespace {

struct Edge {
  std::size_t ring, place;
  std::uint32_t from, to;
  Eigen::Vector2d a, b;
  double low_x() const { return std::min(a.x(), b.x()); }
  double high_x() const { return std::max(a.x(), b.x()); }
};

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
  return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
}

bool boxes_meet(const Edge& e, const Edge& f) {
  return std::min(e.a.y(), e.b.y()) <= std::max(f.a.y(), f.b.y()) &&
         std::min(f.a.y(), f.b.y()) <= std::max(e.a.y(), e.b.y()) && e.low_x() <= f.high_x() &&
         f.low_x() <= e.high_x();
}

bool cross(const Edge& e, const Edge& f) {
  if (!boxes_meet(e, f)) return false;
  return side(e.a, e.b, f.a) * side(e.a, e.b, f.b) <= 0 &&
         side(f.a, f.b, e.a) * side(f.a, f.b, e.b) <= 0;
}

bool share_a_vertex(const Edge& e, const Edge& f) {
  return e.from == f.from || e.from == f.to || e.to == f.from || e.to == f.to;
}

}  // namespace

std::vector<RingCrossing> ring_crossings(std::span<const Ring> rings,
                                         std::span<const Ring2d> positions) {
  std::vector<Edge> edges;
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (std::size_t i = 0; i < rings[r].size(); ++i) {
      const std::size_t j = (i + 1) % rings[r].size();
      edges.push_back({r, i, rings[r][i], rings[r][j], positions[r][i], positions[r][j]});
    }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& e, const Edge& f) { return e.low_x() < f.low_x(); });
  std::vector<RingCrossing> found;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].low_x() <= edges[i].high_x(); ++j)
      if (!share_a_vertex(edges[i], edges[j]) && cross(edges[i], edges[j]))
        found.push_back({edges[i].ring, edges[i].place, edges[j].ring, edges[j].place});
  return found;
}

}  // namespace planum
