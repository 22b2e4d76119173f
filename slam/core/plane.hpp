#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace planum {

/// All x with normal . x == offset.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit
  double offset = 0;                                  ///< m

  double signed_distance(const Eigen::Vector3d& p) const { return normal.dot(p) - offset; }
  Eigen::Vector3d projected(const Eigen::Vector3d& p) const {
    return p - signed_distance(p) * normal;
  }
};

/// The same plane with its normal on the side of a direction.
Plane facing(const Plane& plane, const Eigen::Vector3d& direction);

/// Sums over points from which their centroid and covariance follow; adding two is adding their
/// points. Take points relative to somewhere near them: squares of large numbers cancel badly.
struct PointMoments {
  double count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  ///< sum of p p^T

  void add(const Eigen::Vector3d& p, double weight = 1);
  PointMoments& operator+=(const PointMoments& other);
  Eigen::Vector3d centroid() const { return sum / count; }
  Eigen::Matrix3d covariance() const;  ///< divided by count
};

/// A plane fitted by total least squares.
struct PlaneFit {
  Plane plane;
  Eigen::Vector3d centroid;
  Eigen::Vector3d
      variances;  ///< m^2 along the principal axes, ascending: [0] is the squared rms distance
  Eigen::Matrix3d axes;  ///< columns: the principal axes, in the same order
};

/// Empty if fewer than three points, or if they are collinear.
std::optional<PlaneFit> fit_plane(const PointMoments& moments);
std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3d> points);

}  // namespace planum
