#include "meshing/surface_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include <Eigen/Geometry>

#include "meshing/plane_geometry.hpp"

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Point = Eigen::Vector3d;

/// A triangle may turn so far when a corner moves.
constexpr double least_cosine = 0.5;
/// A new triangle is at least this high, in its longest side, or no flatter than one it replaces.
constexpr double least_height = 0.05;

/// Squared distances to planes, weighted by area: x'Ax - 2 b'x + c.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Point b = Point::Zero();
  double c = 0, weight = 0;

  void add(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    weight += other.weight;
  }

  /// m^2, mean over the area.
  double at(const Point& x) const {
    return weight > 0 ? std::max(0.0, x.dot(a * x) - 2 * b.dot(x) + c) / weight : 0;
  }
};

Point normal_of(const Point& a, const Point& b, const Point& c) { return (b - a).cross(c - a); }

Quadric quadric_of(const Point& a, const Point& b, const Point& c) {
  const Point normal = normal_of(a, b, c);
  const double twice_area = normal.norm();
  if (!(twice_area > 0)) return {};
  const Point n = normal / twice_area;
  const double d = n.dot(a), weight = twice_area / 6;  // a third of the area for each corner
  return {weight * n * n.transpose(), weight * d * n, weight * d * d, weight};
}

/// Height over the longest side, in that side.
double flatness(const Point& a, const Point& b, const Point& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? normal_of(a, b, c).norm() / longest : 0;
}

double squared_distance(const Point& p, const Point& a, const Point& b, const Point& c) {
  const Point normal = normal_of(a, b, c);
  const double squared = normal.squaredNorm();
  if (squared > 0 && normal.dot(normal_of(a, b, p)) >= 0 && normal.dot(normal_of(b, c, p)) >= 0 &&
      normal.dot(normal_of(c, a, p)) >= 0) {
    const double off = normal.dot(p - a);
    return off * off / squared;
  }
  return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                   squared_distance_to_segment(p, c, a)});
}

class Reduction {
 public:
  Reduction(std::span<const Point> points, std::span<const Triangle> triangles,
            const std::vector<bool>& fixed, double max_error)
      : points_(points),
        triangles_(triangles.begin(), triangles.end()),
        fixed_(fixed),
        squared_error_(max_error * max_error),
        removed_(triangles.size(), false),
        covered_(triangles.size()),
        around_(points.size()),
        quadrics_(points.size()),
        versions_(points.size(), 0) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const Quadric quadric = quadric_of(points[a], points[b], points[c]);
      for (const std::uint32_t v : triangles_[t]) {
        around_[v].push_back(t);
        quadrics_[v].add(quadric);
      }
    }
  }

  std::vector<Triangle> run() {
    for (std::uint32_t v = 0; v < points_.size(); ++v) offer(v);
    while (!queue_.empty()) {
      const auto [cost, from, into, version] = queue_.top();
      queue_.pop();
      if (version == versions_[from]) move(from, into);
    }
    std::vector<Triangle> result;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (!removed_[t]) result.push_back(triangles_[t]);
    return result;
  }

 private:
  using Offer = std::tuple<double, std::uint32_t, std::uint32_t, std::uint32_t>;

  /// The neighbours of a vertex, ascending; empty unless its triangles are one closed fan.
  std::vector<std::uint32_t> closed_fan(std::uint32_t v) const {
    // Each triangle leads from one neighbour to the next.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> next;
    for (const std::uint32_t t : around_[v]) {
      const Triangle& corners = triangles_[t];
      const std::size_t k = corner_of(t, v);
      next.emplace_back(corners[(k + 1) % 3], corners[(k + 2) % 3]);
    }
    if (next.size() < 3) return {};
    std::sort(next.begin(), next.end());
    std::uint32_t at = next.front().first;
    for (std::size_t k = 0; k < next.size(); ++k) {
      const auto step = std::lower_bound(next.begin(), next.end(), std::pair(at, 0u));
      if (step == next.end() || step->first != at) return {};
      if (step + 1 != next.end() && (step + 1)->first == at) return {};
      at = step->second;
      if (at == next.front().first && k + 1 < next.size()) return {};
    }
    if (at != next.front().first) return {};
    std::vector<std::uint32_t> result;
    for (const auto& [from, to] : next) result.push_back(from);
    return result;
  }

  std::size_t corner_of(std::uint32_t t, std::uint32_t v) const {
    const Triangle& corners = triangles_[t];
    return corners[0] == v ? 0 : corners[1] == v ? 1 : 2;
  }

  /// Puts the ways to take out a vertex into the queue.
  void offer(std::uint32_t v) {
    ++versions_[v];
    if (fixed_[v] || around_[v].empty()) return;
    for (const std::uint32_t u : closed_fan(v)) {
      const double cost = quadrics_[v].at(points_[u]);
      if (cost <= squared_error_) queue_.emplace(cost, v, u, versions_[v]);
    }
  }

  /// Whether the neighbours that both have are only the two beside their edge: else two sheets
  /// would be joined.
  bool keeps_topology(std::uint32_t from, std::uint32_t into) const {
    const std::vector<std::uint32_t> fan = closed_fan(from);
    std::vector<std::uint32_t> others;
    for (const std::uint32_t t : around_[into])
      for (const std::uint32_t v : triangles_[t])
        if (v != into && v != from) others.push_back(v);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    std::vector<std::uint32_t> common;
    std::set_intersection(fan.begin(), fan.end(), others.begin(), others.end(),
                          std::back_inserter(common));
    return common.size() == 2;
  }

  /// A triangle of `from` with that corner in `into`; empty if nothing is left of it.
  std::optional<Triangle> moved(std::uint32_t t, std::uint32_t from, std::uint32_t into) const {
    Triangle result = triangles_[t];
    for (const std::uint32_t v : result)
      if (v == into) return std::nullopt;
    result[corner_of(t, from)] = into;
    return result;
  }

  bool keeps_shape(std::uint32_t t, const Triangle& now) const {
    const auto [a, b, c] = triangles_[t];
    const Point before = normal_of(points_[a], points_[b], points_[c]);
    const Point after = normal_of(points_[now[0]], points_[now[1]], points_[now[2]]);
    if (!(after.dot(before) >= least_cosine * after.norm() * before.norm()) || after.isZero(0))
      return false;
    const double height = flatness(points_[now[0]], points_[now[1]], points_[now[2]]);
    return height >= least_height || height >= flatness(points_[a], points_[b], points_[c]);
  }

  /// Where in `fan` the nearest triangle is; none if all are too far off.
  std::optional<std::size_t> nearest(const Point& p, const std::vector<Triangle>& fan) const {
    std::optional<std::size_t> result;
    double least = squared_error_;
    for (std::size_t k = 0; k < fan.size(); ++k) {
      const auto& [a, b, c] = fan[k];
      const double squared = squared_distance(p, points_[a], points_[b], points_[c]);
      if (squared > least || (result && squared == least)) continue;
      least = squared;
      result = k;
    }
    return result;
  }

  void move(std::uint32_t from, std::uint32_t into) {
    if (!keeps_topology(from, into)) return;
    std::vector<std::uint32_t> kept;
    std::vector<Triangle> fan;
    for (const std::uint32_t t : around_[from]) {
      const auto now = moved(t, from, into);
      if (!now) continue;
      if (!keeps_shape(t, *now)) return;
      kept.push_back(t);
      fan.push_back(*now);
    }
    std::vector<std::vector<std::uint32_t>> covered(fan.size());
    const auto cover = [&](std::uint32_t p) {
      const auto k = nearest(points_[p], fan);
      if (k) covered[*k].push_back(p);
      return k.has_value();
    };
    if (!cover(from)) return;
    for (const std::uint32_t t : around_[from])
      for (const std::uint32_t p : covered_[t])
        if (!cover(p)) return;
    replace(from, into, kept, fan, covered);
  }

  void replace(std::uint32_t from, std::uint32_t into, const std::vector<std::uint32_t>& kept,
               const std::vector<Triangle>& fan, std::vector<std::vector<std::uint32_t>>& covered) {
    std::vector<std::uint32_t> changed = closed_fan(from);
    for (const std::uint32_t t : around_[from]) removed_[t] = true;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      triangles_[kept[k]] = fan[k];
      covered_[kept[k]] = std::move(covered[k]);
      removed_[kept[k]] = false;
      around_[into].push_back(kept[k]);
    }
    for (const std::uint32_t v : changed)
      std::erase_if(around_[v], [&](std::uint32_t t) { return removed_[t]; });
    around_[from].clear();
    quadrics_[into].add(quadrics_[from]);
    ++versions_[from];
    for (const std::uint32_t v : changed) offer(v);
  }

  std::span<const Point> points_;
  std::vector<Triangle> triangles_;
  const std::vector<bool>& fixed_;
  double squared_error_;                             ///< m^2
  std::vector<bool> removed_;                        ///< of each triangle
  std::vector<std::vector<std::uint32_t>> covered_;  ///< vertices a triangle stands for
  std::vector<std::vector<std::uint32_t>> around_;   ///< triangles at each vertex
  std::vector<Quadric> quadrics_;                    ///< of the surface each vertex stands for
  std::vector<std::uint32_t> versions_;              ///< offers of earlier ones are void
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> queue_;
};

}  // namespace

std::vector<Triangle> reduced_surface(std::span<const Point> points,
                                      std::span<const Triangle> triangles,
                                      const std::vector<bool>& fixed, double max_error) {
  if (!(max_error > 0)) return {triangles.begin(), triangles.end()};
  return Reduction(points, triangles, fixed, max_error).run();
}

}  // namespace planum
