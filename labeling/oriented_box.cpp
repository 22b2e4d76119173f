#include "labeling/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planum {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double reach(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& direction) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Eigen::Vector2d& p : points) {
    low = std::min(low, direction.dot(p));
    high = std::max(high, direction.dot(p));
  }
  return high - low;
}

/// One side of the hull, of points in ascending order.
template <class Points>
void add_chain(const Points& points, std::vector<Eigen::Vector2d>& hull) {
  const std::size_t start = hull.size();
  for (const Eigen::Vector2d& p : points) {
    while (hull.size() >= start + 2 &&
           cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
      hull.pop_back();
    hull.push_back(p);
  }
  hull.pop_back();
}

}  // namespace

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Eigen::Vector2d> hull;
  add_chain(points, hull);
  std::reverse(points.begin(), points.end());
  add_chain(points, hull);
  return hull;
}

double direction_of_smallest_rectangle(const std::vector<Eigen::Vector2d>& points) {
  const std::vector<Eigen::Vector2d> hull = convex_hull(points);
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size() && hull.size() > 1; ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const Eigen::Vector2d x = edge.normalized(), y(-x.y(), x.x());
    const double area = reach(hull, x) * reach(hull, y);
    if (area >= least) continue;
    least = area;
    best = std::atan2(x.y(), x.x());
  }
  return best;
}

}  // namespace planum
