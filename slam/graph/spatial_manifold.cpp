#include <cmath>

#include <Eigen/Geometry>

#include "slam/graph/pose_manifold.hpp"

namespace planum {
namespace {

/// The inverse of the left Jacobian of SO(3); its transpose is that of the right one.
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& rotation_vector) {
  const double squared = rotation_vector.squaredNorm(), angle = std::sqrt(squared);
  const double c = angle < 1e-3 ? 1.0 / 12 + squared / 720
                                : 1 / squared - 1 / (2 * angle * std::tan(0.5 * angle));
  const Eigen::Matrix3d w = skew(rotation_vector);
  return Eigen::Matrix3d::Identity() - 0.5 * w + c * w * w;
}

/// The unit quaternion of a rotation with a scalar part that is not negative.
Eigen::Quaterniond short_quaternion(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

Eigen::Vector3d rotation_error(const Eigen::Quaterniond& q, RotationError kind) {
  if (kind == RotationError::chord) return 2 * q.vec();
  const double sine_half = q.vec().norm();
  return (sine_half < 1e-12 ? 2.0 : 2 * std::atan2(sine_half, q.w()) / sine_half) * q.vec();
}

}  // namespace

Pose SpatialManifold::moved(const Pose& pose, const Vector& motion) {
  const Eigen::Vector3d turn = motion.tail<3>();
  const double angle = turn.norm();
  const double scale = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(0.5 * angle);
  q.vec() = scale * turn;
  Pose result = Pose::Identity();
  result.translation() = pose.translation() + pose.linear() * motion.head<3>();
  result.linear() = (Eigen::Quaterniond(pose.linear()) * q).normalized().toRotationMatrix();
  return result;
}

Vector6d SpatialManifold::error(const Pose& from, const Pose& to, const Pose& measured,
                                RotationError kind) {
  const Eigen::Matrix3d to_measured = measured.linear().transpose();
  const Eigen::Matrix3d rest = to_measured * (from.linear().transpose() * to.linear());
  const Eigen::Vector3d u = from.linear().transpose() * (to.translation() - from.translation());
  Vector6d e;
  e.head<3>() = to_measured * (u - measured.translation());
  e.tail<3>() = rotation_error(short_quaternion(rest), kind);
  return e;
}

LinearizedError<6> SpatialManifold::linearized(const Pose& from, const Pose& to,
                                               const Pose& measured, RotationError kind) {
  const Eigen::Matrix3d to_measured = measured.linear().transpose();
  const Eigen::Matrix3d rest = to_measured * (from.linear().transpose() * to.linear());
  const Eigen::Vector3d u = from.linear().transpose() * (to.translation() - from.translation());
  const Eigen::Quaterniond q = short_quaternion(rest);
  LinearizedError<6> result;
  result.error.head<3>() = to_measured * (u - measured.translation());
  result.error.tail<3>() = rotation_error(q, kind);

  // E becomes exp(-R_measured^T dr_from) E exp(dr_to). For the chord, the product of quaternions
  // gives w I -+ [v]; for the angle, the Jacobians of the logarithm.
  Eigen::Matrix3d left;
  if (kind == RotationError::chord) {
    left = -skew(q.vec());
    left.diagonal().array() += q.w();
  } else {
    left = inverse_left_jacobian(result.error.tail<3>());
  }
  result.by_from.topLeftCorner<3, 3>() = -to_measured;
  result.by_from.topRightCorner<3, 3>() = to_measured * skew(u);
  result.by_from.bottomLeftCorner<3, 3>().setZero();
  result.by_from.bottomRightCorner<3, 3>() = -left * to_measured;
  result.by_to.topLeftCorner<3, 3>() = rest;
  result.by_to.topRightCorner<3, 3>().setZero();
  result.by_to.bottomLeftCorner<3, 3>().setZero();
  result.by_to.bottomRightCorner<3, 3>() = left.transpose();
  return result;
}

Pose SpatialManifold::pose(const Rotation& rotation, const Position& position) {
  Pose result = Pose::Identity();
  result.linear() = rotation;
  result.translation() = position;
  return result;
}

}  // namespace planum
