#include <cmath>

#include <Eigen/Geometry>

#include "slam/graph/pose_manifold.hpp"

namespace planum {
namespace {

Eigen::Matrix2d turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

/// The same angle in [-pi, pi].
double wrapped(double angle) { return std::remainder(angle, 2 * pi); }

}  // namespace

PlanarPose PlanarManifold::moved(const PlanarPose& pose, const Vector& motion) {
  return {.position = pose.position + turn(pose.heading) * motion.head<2>(),
          .heading = wrapped(pose.heading + motion.z())};
}

PlanarPose PlanarManifold::product(const PlanarPose& a, const PlanarPose& b) {
  return {.position = a.position + turn(a.heading) * b.position,
          .heading = wrapped(a.heading + b.heading)};
}

PlanarPose PlanarManifold::inverse(const PlanarPose& pose) {
  return {.position = -(turn(-pose.heading) * pose.position), .heading = -pose.heading};
}

Eigen::Matrix3d PlanarManifold::world_from_own(const PlanarPose& pose) {
  Matrix m = Matrix::Identity();
  m.topLeftCorner<2, 2>() = turn(pose.heading);
  m.topRightCorner<2, 1>() << pose.position.y(), -pose.position.x();
  return m;
}

Eigen::Vector3d PlanarManifold::error(const PlanarPose& from, const PlanarPose& to,
                                      const PlanarPose& measured, RotationError kind) {
  const Eigen::Vector2d u = turn(-from.heading) * (to.position - from.position);
  const double angle = wrapped(to.heading - from.heading - measured.heading);
  Vector e;
  e.head<2>() = turn(-measured.heading) * (u - measured.position);
  e.z() = kind == RotationError::angle ? angle : 2 * std::sin(0.5 * angle);
  return e;
}

LinearizedError<3> PlanarManifold::linearized(const PlanarPose& from, const PlanarPose& to,
                                              const PlanarPose& measured, RotationError kind) {
  const Eigen::Matrix2d to_measured = turn(-measured.heading), to_from = turn(-from.heading);
  const Eigen::Vector2d u = to_from * (to.position - from.position);
  const double angle = wrapped(to.heading - from.heading - measured.heading);
  const bool is_angle = kind == RotationError::angle;
  const double slope = is_angle ? 1.0 : std::cos(0.5 * angle);
  LinearizedError<3> result;
  result.error.head<2>() = to_measured * (u - measured.position);
  result.error.z() = is_angle ? angle : 2 * std::sin(0.5 * angle);
  result.by_from.topLeftCorner<2, 2>() = -to_measured;
  result.by_from.topRightCorner<2, 1>() = to_measured * Eigen::Vector2d(u.y(), -u.x());
  result.by_from.bottomRows<1>() << 0, 0, -slope;
  result.by_to.topLeftCorner<2, 2>() = turn(angle);
  result.by_to.topRightCorner<2, 1>().setZero();
  result.by_to.bottomRows<1>() << 0, 0, slope;
  return result;
}

Eigen::Matrix2d PlanarManifold::rotation(const PlanarPose& pose) { return turn(pose.heading); }

PlanarPose PlanarManifold::pose(const Rotation& rotation, const Position& position) {
  return {.position = position, .heading = std::atan2(rotation(1, 0), rotation(0, 0))};
}

bool PlanarManifold::finite(const PlanarPose& pose) {
  return pose.position.allFinite() && std::isfinite(pose.heading);
}

}  // namespace planum
