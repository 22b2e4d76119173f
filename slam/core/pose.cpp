#include "slam/core/pose.hpp"

#include <cmath>

namespace planum {
namespace {

/// Coefficients of the series around 0 and their closed forms: sin(a)/a, (1-cos a)/a^2, (a-sin
/// a)/a^3.
struct RotationCoefficients {
  double sine, versine, cubic;
};

RotationCoefficients rotation_coefficients(double angle) {
  const double squared = angle * angle;
  if (angle < 1e-4) return {1 - squared / 6, 0.5 - squared / 24, 1.0 / 6 - squared / 120};
  return {std::sin(angle) / angle, (1 - std::cos(angle)) / squared,
          (angle - std::sin(angle)) / (squared * angle)};
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Pose exp_se3(const Vector6d& twist) {
  const Eigen::Vector3d omega = twist.tail<3>();
  const auto [sine, versine, cubic] = rotation_coefficients(omega.norm());
  const Eigen::Matrix3d w = skew(omega);
  const Eigen::Matrix3d left_jacobian = Eigen::Matrix3d::Identity() + versine * w + cubic * w * w;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Matrix3d::Identity() + sine * w + versine * w * w;
  pose.translation() = left_jacobian * twist.head<3>();
  return pose;
}

Vector6d log_se3(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const double sine_half = q.vec().norm();
  // atan2 is exact near 0 and near pi, where the arc cosine of the trace is not.
  const double angle = 2 * std::atan2(sine_half, std::abs(q.w()));
  const double scale = sine_half < 1e-12 ? 2.0 : angle / sine_half;
  const Eigen::Vector3d omega = (q.w() < 0 ? -scale : scale) * q.vec();
  const Eigen::Matrix3d w = skew(omega);
  const double squared = angle * angle;
  // 1/a^2 - (1 + cos a) / (2 a sin a), with its series around 0.
  const double c = angle < 1e-3
                       ? 1.0 / 12 + squared / 720
                       : 1 / squared - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  Vector6d twist;
  twist.head<3>() = (Eigen::Matrix3d::Identity() - 0.5 * w + c * w * w) * pose.translation();
  twist.tail<3>() = omega;
  return twist;
}

Matrix6d adjoint(const Pose& pose) {
  Matrix6d m = Matrix6d::Zero();
  m.topLeftCorner<3, 3>() = pose.linear();
  m.bottomRightCorner<3, 3>() = pose.linear();
  m.topRightCorner<3, 3>() = skew(pose.translation()) * pose.linear();
  return m;
}

double rotation_angle(const Pose& a, const Pose& b) {
  const Eigen::Quaterniond q(a.linear().transpose() * b.linear());
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Pose pose_from_xyz_ypr(const Eigen::Vector3d& position, double yaw, double pitch, double roll) {
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() = position;
  return pose;
}

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Pose orthonormalized(const Pose& pose) {
  Pose result = pose;
  result.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  return result;
}

}  // namespace planum
