#include "meshing/plane_geometry.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace planum {

PlaneFrame::PlaneFrame(const Plane& plane)
    : origin_(plane.offset * plane.normal),
      u_(plane.normal.unitOrthogonal()),
      v_(plane.normal.cross(u_)) {}

Eigen::Vector2d PlaneFrame::flat(const Eigen::Vector3d& p) const { return {u_.dot(p), v_.dot(p)}; }

Eigen::Vector3d PlaneFrame::raised(const Eigen::Vector2d& p) const {
  return origin_ + p.x() * u_ + p.y() * v_;
}

double signed_area(std::span<const Eigen::Vector2d> ring) {
  double sum = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i - 1] - ring[0], b = ring[i] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / 2;
}

bool is_inside(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Eigen::Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    inside ^= point.x() < a.x() + (point.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y());
  }
  return inside;
}

double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length_squared = along.squaredNorm();
  const double t =
      length_squared > 0 ? std::clamp((p - a).dot(along) / length_squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).squaredNorm();
}

}  // namespace planum
