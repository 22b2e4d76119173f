#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/plane.hpp"

namespace planum {

using Ring2d = std::vector<Eigen::Vector2d>;  ///< m; the last vertex is joined to the first

/// Coordinates in a plane: counter-clockwise seen from the tip of its normal stays so.
class PlaneFrame {
 public:
  explicit PlaneFrame(const Plane& plane);
  Eigen::Vector2d flat(const Eigen::Vector3d& p) const;
  Eigen::Vector3d raised(const Eigen::Vector2d& p) const;

 private:
  Eigen::Vector3d origin_, u_, v_;
};

/// Positive if counter-clockwise (m^2).
double signed_area(std::span<const Eigen::Vector2d> ring);

/// Even-odd rule; what lies on the ring may be either.
bool is_inside(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& point);

/// m^2, from a point to the nearest place between a and b.
double squared_distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b);

}  // namespace planum
