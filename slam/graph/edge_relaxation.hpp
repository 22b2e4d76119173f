#pragma once

#include <vector>

#include "slam/graph/lu_milios_system.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// What an edge says about small motions of its poses, linearized where they are: pose a is `to`, b
/// is `from`, motions are X <- exp_se3(x) X, and the error of the edge is that of edge_error().
LinkEquation edge_equation(const Edge& edge, const Matrix6d& information,
                           const std::vector<Pose>& poses);

/// m and rad; poses that nothing determines stay where they are within about this much a step.
Vector6d gentle_damping();

struct EdgeRelaxation {
  std::vector<Pose> poses;  ///< world_from_scan
  double error_before = 0;  ///< sum of e' I e over the accepted edges
  double error_after = 0;
  int iterations = 0;
  bool converged = false;
};

/// Poses that agree best with the accepted edges of a graph, by the Lu/Milios system again and
/// again, from where elch() brings them if that is better. The first pose of whatever hangs
/// together stays fixed. It closes loops before scans are matched all at once. Throws Error if an
/// edge joins poses that are not there, or is not finite.
EdgeRelaxation relax_edges(const PoseGraph& graph);

}  // namespace planum
