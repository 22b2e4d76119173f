#include "labeling/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planum {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

constexpr double hardly_larger = 1.3;  // times the least area

/// A rectangle round points, by its directions.
struct Rectangle {
  Eigen::Matrix2d axes_from_world;
  Eigen::AlignedBox2d box;  ///< m, along the axes

  Rectangle(const Eigen::Vector2d& x, const std::vector<Eigen::Vector2d>& points) {
    axes_from_world << x.x(), x.y(), -x.y(), x.x();
    for (const Eigen::Vector2d& p : points) box.extend(axes_from_world * p);
  }
  double distance_to_sides(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d at = axes_from_world * p;
    return std::min((at - box.min()).minCoeff(), (box.max() - at).minCoeff());
  }
};

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

double direction_of_rectangle(const std::vector<Eigen::Vector2d>& points) {
  const std::vector<Eigen::Vector2d> hull = convex_hull(points);
  if (hull.size() < 2) return 0;
  std::vector<Rectangle> rectangles;
  double least_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    rectangles.emplace_back(edge.normalized(), hull);
    least_area = std::min(least_area, rectangles.back().box.volume());
  }
  double best = 0, least_distance = std::numeric_limits<double>::infinity();
  for (const Rectangle& rectangle : rectangles) {
    if (rectangle.box.volume() > hardly_larger * least_area) continue;
    double distance = 0;
    for (const Eigen::Vector2d& p : points) distance += rectangle.distance_to_sides(p);
    if (distance >= least_distance) continue;
    least_distance = distance;
    best = std::atan2(rectangle.axes_from_world(0, 1), rectangle.axes_from_world(0, 0));
  }
  return best;
}

}  // namespace planum
