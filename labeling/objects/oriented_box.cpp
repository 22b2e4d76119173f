#include "labeling/objects/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace planum {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

constexpr double hardly_larger = 1.3;  // times the least area

/// From where to where numbers reach, without `strays` of them at each end.
std::pair<double, double> reach(std::vector<double> values, std::size_t strays) {
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(strays),
             high = values.end() - 1 - static_cast<std::ptrdiff_t>(strays);
  std::nth_element(values.begin(), low, values.end());
  const double least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

/// A rectangle round points, one side along a direction.
struct Rectangle {
  double direction = 0;  ///< rad
  double area = 0;       ///< m^2
  double distance = 0;   ///< m, sum over the points, to the nearest side
};

Rectangle rectangle_round(const std::vector<Eigen::Vector2d>& points, double direction,
                          std::size_t strays) {
  const Eigen::Vector2d x(std::cos(direction), std::sin(direction)), y(-x.y(), x.x());
  std::vector<double> xs, ys;
  for (const Eigen::Vector2d& p : points) {
    xs.push_back(x.dot(p));
    ys.push_back(y.dot(p));
  }
  const auto [x0, x1] = reach(xs, strays);
  const auto [y0, y1] = reach(ys, strays);
  Rectangle rectangle{direction, (x1 - x0) * (y1 - y0), 0};
  for (std::size_t i = 0; i < points.size(); ++i)
    rectangle.distance += std::min(std::min(std::abs(xs[i] - x0), std::abs(x1 - xs[i])),
                                   std::min(std::abs(ys[i] - y0), std::abs(y1 - ys[i])));
  return rectangle;
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

double direction_of_rectangle(const std::vector<Eigen::Vector2d>& points, double max_stray) {
  constexpr double step = radians(0.5);
  constexpr int steps = 10;  // to either side
  const std::vector<Eigen::Vector2d> hull = convex_hull(points);
  if (hull.size() < 2) return 0;
  const auto strays = static_cast<std::size_t>(max_stray * static_cast<double>(points.size()));
  std::vector<Rectangle> rectangles;
  double least_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    rectangles.push_back(rectangle_round(points, std::atan2(edge.y(), edge.x()), strays));
    least_area = std::min(least_area, rectangles.back().area);
  }
  Rectangle best{0, 0, std::numeric_limits<double>::infinity()};
  for (const Rectangle& rectangle : rectangles)
    if (rectangle.area <= hardly_larger * least_area && rectangle.distance < best.distance)
      best = rectangle;
  const double middle = best.direction;
  for (int i = -steps; i <= steps; ++i) {
    const Rectangle rectangle = rectangle_round(points, middle + i * step, strays);
    if (rectangle.distance < best.distance) best = rectangle;
  }
  return best.direction;
}

}  // namespace planum
