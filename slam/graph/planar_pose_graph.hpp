#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "slam/core/planar_pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// As Edge, in the plane.
struct PlanarEdge {
  std::size_t from = 0, to = 0;                               ///< positions in poses
  PlanarPose from_from_to{};                                  ///< measured
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< of (x, y, heading)
  EdgeKind kind = EdgeKind::odometry;
  bool accepted = true;  ///< others are left out of account
};

/// As PoseGraph, in the plane (SE(2)).
struct PlanarPoseGraph {
  std::vector<PlanarPose> poses;  ///< world_from_pose
  std::vector<PlanarEdge> edges;
};

}  // namespace planum
