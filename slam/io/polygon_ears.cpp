#include "slam/io/polygon_ears.hpp"

#include <algorithm>
#include <cassert>

#include <Eigen/Geometry>

namespace planum {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// The corners in the polygon's plane, counter-clockwise; its normal by Newell's method.
Points projected(std::span<const Eigen::Vector3f> vertices,
                 std::span<const std::uint32_t> corners) {
  const Eigen::Vector3d origin = vertices[corners[0]].cast<double>();
  const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
    return vertices[corners[i % corners.size()]].cast<double>() - origin;
  };
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) normal += corner(i).cross(corner(i + 1));
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.normalized().cross(u);
  Points points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    points.emplace_back(corner(i).dot(u), corner(i).dot(v));
  return points;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

/// The polygon that is left, as positions in the list of its corners.
struct Remainder {
  const Points& points;
  std::vector<std::uint32_t> corners;

  std::uint32_t at(std::size_t i) const { return corners[i % corners.size()]; }

  /// Twice the area of the triangle at corner i, negative where the polygon is reflex.
  double area_at(std::size_t i) const {
    return cross(points[at(i + corners.size() - 1)], points[at(i)], points[at(i + 1)]);
  }

  /// A convex corner whose triangle holds no other corner.
  bool is_ear(std::size_t i) const {
    if (!(area_at(i) > 0)) return false;
    const Eigen::Vector2d& a = points[at(i + corners.size() - 1)];
    const Eigen::Vector2d& b = points[at(i)];
    const Eigen::Vector2d& c = points[at(i + 1)];
    return std::none_of(corners.begin(), corners.end(), [&](std::uint32_t k) {
      const Eigen::Vector2d& p = points[k];
      // A corner that is there twice (a hole joined by a cut) does not block its own ear.
      if (p == a || p == b || p == c) return false;
      return cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0;
    });
  }

  std::size_t best_to_clip() const {
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (is_ear(i)) return i;
    // Degenerate or crossing itself: the corner that is least reflex.
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (area_at(i) > area_at(best)) best = i;
    return best;
  }
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulated_polygon(
    std::span<const Eigen::Vector3f> vertices, std::span<const std::uint32_t> corners) {
  assert(corners.size() >= 3);
  if (corners.size() == 3) return {{corners[0], corners[1], corners[2]}};
  const Points points = projected(vertices, corners);
  Remainder rest = {.points = points, .corners = {}};
  for (std::uint32_t i = 0; i < corners.size(); ++i) rest.corners.push_back(i);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  while (rest.corners.size() > 3) {
    const std::size_t ear = rest.best_to_clip();
    triangles.push_back({corners[rest.at(ear + rest.corners.size() - 1)], corners[rest.at(ear)],
                         corners[rest.at(ear + 1)]});
    rest.corners.erase(rest.corners.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({corners[rest.at(0)], corners[rest.at(1)], corners[rest.at(2)]});
  return triangles;
}

}  // namespace planum
