#pragma once

#include <Eigen/Core>

#include "meshing/plane_geometry.hpp"
#include "slam/core/plane.hpp"

namespace planum {

/// How much points near a plane bend away from it: least squares of
/// height = a + b u + c v + d u^2 + e u v + f v^2 over the plane.
class CurvatureFit {
 public:
  /// `origin` is a point near the plane and the points.
  CurvatureFit(const Plane& plane, const Eigen::Vector3d& origin);
  void add(const Eigen::Vector3d& point, double weight);
  /// Largest principal curvature (1/m); 0 where the points do not say.
  double curvature() const;

 private:
  Plane plane_;
  PlaneFrame frame_;
  Eigen::Vector3d origin_;
  Eigen::Matrix<double, 6, 6> squares_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> heights_ = Eigen::Matrix<double, 6, 1>::Zero();
};

}  // namespace planum
