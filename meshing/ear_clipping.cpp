#include "meshing/ear_clipping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class EarClipper {
 public:
  explicit EarClipper(std::span<const Ring2d> rings) {
    std::vector<std::vector<std::uint32_t>> loops;
    for (const Ring2d& ring : rings) {
      std::vector<std::uint32_t>& loop = loops.emplace_back(ring.size());
      std::iota(loop.begin(), loop.end(), static_cast<std::uint32_t>(points_.size()));
      points_.insert(points_.end(), ring.begin(), ring.end());
    }
    if (loops.empty()) return;
    ring_ = loops.front();
    loops.erase(loops.begin());
    // From right to left: the bridge of a hole then never passes through a hole still to come.
    const auto rightmost = [&](const std::vector<std::uint32_t>& loop) {
      return *std::max_element(loop.begin(), loop.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points_[a].x() < points_[b].x();
      });
    };
    std::stable_sort(loops.begin(), loops.end(), [&](const auto& a, const auto& b) {
      return points_[rightmost(a)].x() > points_[rightmost(b)].x();
    });
    for (const auto& loop : loops)
      if (!loop.empty()) join(loop, rightmost(loop));
  }

  std::vector<Triangle> clipped() {
    std::vector<Triangle> triangles;
    while (ring_.size() > 3) {
      const std::size_t ear = best_ear();
      triangles.push_back({at(ear + ring_.size() - 1), at(ear), at(ear + 1)});
      ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    if (ring_.size() == 3) triangles.push_back({ring_[0], ring_[1], ring_[2]});
    return triangles;
  }

 private:
  std::uint32_t at(std::size_t i) const { return ring_[i % ring_.size()]; }

  /// Joins a hole to the ring by the shortest bridge from its rightmost vertex that crosses
  /// nothing.
  void join(const std::vector<std::uint32_t>& hole, std::uint32_t from) {
    std::vector<std::size_t> order(ring_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto off = [&](std::size_t i) {
      return (points_[ring_[i]] - points_[from]).squaredNorm();
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return off(a) < off(b); });
    std::size_t bridge = order.front();
    for (const std::size_t i : order)
      if (sees(i, from) && !crosses(ring_, at(i), from) && !crosses(hole, at(i), from)) {
        bridge = i;
        break;
      }
    const auto start = std::find(hole.begin(), hole.end(), from);
    std::vector<std::uint32_t> detour(start, hole.end());
    detour.insert(detour.end(), hole.begin(), start);
    detour.push_back(from);
    detour.push_back(ring_[bridge]);
    ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(bridge) + 1, detour.begin(),
                 detour.end());
  }

  /// Whether a point lies inside the angle of the ring at place i.
  bool sees(std::size_t i, std::uint32_t point) const {
    const Eigen::Vector2d &before = points_[at(i + ring_.size() - 1)], &here = points_[at(i)],
                          &after = points_[at(i + 1)], &p = points_[point];
    if (turn(before, here, after) >= 0)
      return turn(before, here, p) >= 0 && turn(here, after, p) >= 0;
    return turn(before, here, p) >= 0 || turn(here, after, p) >= 0;
  }

  bool crosses(const std::vector<std::uint32_t>& ring, std::uint32_t a, std::uint32_t b) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t c = ring[i], d = ring[(i + 1) % ring.size()];
      if (same(c, a) || same(c, b) || same(d, a) || same(d, b)) continue;
      if (turn(points_[a], points_[b], points_[c]) * turn(points_[a], points_[b], points_[d]) <=
              0 &&
          turn(points_[c], points_[d], points_[a]) * turn(points_[c], points_[d], points_[b]) <= 0)
        return true;
    }
    return false;
  }

  bool same(std::uint32_t a, std::uint32_t b) const { return points_[a] == points_[b]; }

  /// The sine of the smallest angle of a triangle, roughly: its height over its longest side.
  double quality(std::size_t i) const {
    const Eigen::Vector2d &a = points_[at(i + ring_.size() - 1)], &b = points_[at(i)],
                          &c = points_[at(i + 1)];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0 ? turn(a, b, c) / longest : 0;
  }

  bool is_ear(std::size_t i) const {
    const std::uint32_t a = at(i + ring_.size() - 1), b = at(i), c = at(i + 1);
    for (const std::uint32_t p : ring_) {
      if (same(p, a) || same(p, b) || same(p, c)) continue;
      if (turn(points_[a], points_[b], points_[p]) >= 0 &&
          turn(points_[b], points_[c], points_[p]) >= 0 &&
          turn(points_[c], points_[a], points_[p]) >= 0)
        return false;
    }
    return true;
  }

  std::size_t best_ear() const {
    std::size_t best = 0;
    double best_quality = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const double here = quality(i);
      if (here <= best_quality || here < 0 || !is_ear(i)) continue;
      best = i;
      best_quality = here;
    }
    return best;
  }

  std::vector<Eigen::Vector2d> points_;
  std::vector<std::uint32_t> ring_;  ///< what is left of the polygon
};

}  // namespace

std::vector<Triangle> clipped_ears(std::span<const Ring2d> rings) {
  return EarClipper(rings).clipped();
}

}  // namespace planum
