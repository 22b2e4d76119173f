#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// A pose in the plane; named `b_from_a` as poses in space are.
struct PlanarPose {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< m
  double heading = 0;                                  ///< rad, counter-clockwise
};

/// As Edge, in the plane.
struct PlanarEdge {
  std::size_t from = 0, to = 0;                               ///< indices of poses
  PlanarPose from_from_to;                                    ///< measured
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< of (x, y, heading)
  EdgeKind kind = EdgeKind::odometry;
  bool accepted = true;  ///< others are left out of account
};

/// As PoseGraph, in the plane (SE(2)).
struct PlanarPoseGraph {
  std::vector<PlanarPose> poses;  ///< world_from_pose
  std::vector<PlanarEdge> edges;
};

/// The pose in space with z = 0 that only turns about z.
Pose lifted(const PlanarPose& pose);

/// The pose in the plane below a pose in space.
PlanarPose flattened(const Pose& pose);

}  // namespace planum
