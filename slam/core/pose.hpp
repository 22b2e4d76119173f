#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace planum {

/// A rigid transform; named `b_from_a`, it takes points in frame a to frame b.
using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

inline constexpr double pi = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / pi); }

/// A value for each of the three translations, and one for each of the three rotations.
inline Vector6d both_parts(double translation, double rotation) {
  Vector6d result;
  result << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return result;
}

/// The matrix of the cross product: skew(a) * b == a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// SE(3) exponential of a twist (translation part first, then rotation, metres and radians).
Pose exp_se3(const Vector6d& twist);

/// SE(3) logarithm, the inverse of exp_se3 for rotations below pi.
Vector6d log_se3(const Pose& pose);

/// The adjoint: exp_se3(adjoint(T) * x) == T * exp_se3(x) * T^-1.
Matrix6d adjoint(const Pose& pose);

/// Angle of the rotation between two poses, rad, in [0, pi].
double rotation_angle(const Pose& a, const Pose& b = Pose::Identity());

/// Rz(yaw) Ry(pitch) Rx(roll) at a position; angles in radians.
Pose pose_from_xyz_ypr(const Eigen::Vector3d& position, double yaw, double pitch, double roll);

/// The smallest turn after which a direction is another one.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// The same pose with its rotation made orthonormal again (after long products).
Pose orthonormalized(const Pose& pose);

}  // namespace planum
