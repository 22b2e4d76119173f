#pragma once

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/graph/planar_pose_graph.hpp"

namespace planum {

/// How far a rotation E is from none.
enum class RotationError {
  chord,  ///< 2 sin(angle / 2) about its axis, i.e. twice the vector part of its unit quaternion
  angle,  ///< its angle about its axis, i.e. its logarithm
};

/// The error of one edge and its derivatives by small motions of the two poses.
template <int N>
struct LinearizedError {
  Eigen::Matrix<double, N, 1> error;
  Eigen::Matrix<double, N, N> by_from, by_to;
};

/// What the solver must know about poses in space. A small motion (translation, rotation vector) of
/// a pose is given in its own frame: t <- t + R dt, R <- R exp(dr). The error of an edge is that of
/// g2o (Kuemmerle et al. 2011) with the rotation in radians: with u = R_from^T (t_to - t_from) and
/// E = R_measured^T R_from^T R_to, (R_measured^T (u - t_measured), rotation error of E).
struct SpatialManifold {
  static constexpr int dimension = 6;  ///< of a small motion
  static constexpr int space = 3;      ///< of a position
  using PoseType = Pose;
  using EdgeType = Edge;
  using GraphType = PoseGraph;
  using Vector = Vector6d;
  using Matrix = Matrix6d;
  using Rotation = Eigen::Matrix3d;
  using Position = Eigen::Vector3d;

  static Pose identity() { return Pose::Identity(); }
  static Pose moved(const Pose& pose, const Vector& motion);
  static Pose product(const Pose& a, const Pose& b) { return a * b; }
  static Pose inverse(const Pose& pose) { return pose.inverse(); }
  /// What a small motion of a pose in its own frame is as a motion of the world at its origin.
  static Matrix world_from_own(const Pose& pose) { return adjoint(pose); }
  static Vector error(const Pose& from, const Pose& to, const Pose& measured, RotationError kind);
  static LinearizedError<6> linearized(const Pose& from, const Pose& to, const Pose& measured,
                                       RotationError kind);
  static Rotation rotation(const Pose& pose) { return pose.linear(); }
  static Position position(const Pose& pose) { return pose.translation(); }
  static Pose pose(const Rotation& rotation, const Position& position);
  static bool finite(const Pose& pose) { return pose.matrix().allFinite(); }
};

/// The same in the plane; here the rotation error of the angle a is a, or 2 sin(a / 2).
struct PlanarManifold {
  static constexpr int dimension = 3;
  static constexpr int space = 2;
  using PoseType = PlanarPose;
  using EdgeType = PlanarEdge;
  using GraphType = PlanarPoseGraph;
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  using Rotation = Eigen::Matrix2d;
  using Position = Eigen::Vector2d;

  static PlanarPose identity() { return {}; }
  static PlanarPose moved(const PlanarPose& pose, const Vector& motion);
  static PlanarPose product(const PlanarPose& a, const PlanarPose& b);
  static PlanarPose inverse(const PlanarPose& pose);
  static Matrix world_from_own(const PlanarPose& pose);
  static Vector error(const PlanarPose& from, const PlanarPose& to, const PlanarPose& measured,
                      RotationError kind);
  static LinearizedError<3> linearized(const PlanarPose& from, const PlanarPose& to,
                                       const PlanarPose& measured, RotationError kind);
  static Rotation rotation(const PlanarPose& pose);
  static Position position(const PlanarPose& pose) { return pose.position; }
  static PlanarPose pose(const Rotation& rotation, const Position& position);
  static bool finite(const PlanarPose& pose);
};

}  // namespace planum
