#pragma once

#include <cstddef>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/gravity.hpp"
#include "slam/graph/information_repair.hpp"
#include "slam/graph/planar_pose_graph.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// Where the optimization of a graph starts.
enum class GraphStart {
  best,   ///< at the given poses or at those of the edges, whichever have the lower cost
  given,  ///< at the poses of the graph
  edges,  ///< at poses from the edges alone (chordal_initialization)
};

/// Whether loop edges may be left out of account. Odometry never is.
enum class LoopRejection {
  never,
  /// Only if, with all loops, one of them is off more than the worst of as many right ones would be
  /// in 99 of 100 graphs.
  if_needed,
  always,  ///< also where noise is far less than information claims
};

struct GraphParams {
  GraphStart start = GraphStart::best;
  LoopRejection rejection = LoopRejection::if_needed;
  double loop_gate = 2.33;  ///< RobustParams::gate
  /// Poses that stay where they are; of a part of the graph that has none, the first.
  std::vector<std::size_t> fixed{};
  std::vector<GravityObservation> gravity{};      ///< in space only
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the world; any length but zero
  int max_iterations = 100;                       ///< 0: only the start
  double tolerance = 1e-10;  ///< done when a step promises to lower the cost by less of it
  bool covariances = true;   ///< also find them
};

/// How good an optimized graph is, in space or in the plane.
struct GraphQuality {
  bool converged = false;
  double cost_before = 0;  ///< sum of e' I e over all accepted edges at the given poses, plus that
                           ///< of gravity; infinite if a pose was not finite
  double cost_after = 0;   ///< the same over the edges that count, at the new poses
  int iterations = 0;      ///< systems solved, for the choice of loops too
  std::vector<bool> counts;            ///< of each edge: accepted before, and not rejected now
  std::vector<double> squared_errors;  ///< e' I e of each edge at the new poses
  double noise_scale = 1;  ///< true noise / that of the information, where loops were doubted
  std::vector<RepairedInformation> repaired;         ///< edges with indefinite information
  std::vector<std::vector<std::size_t>> components;  ///< poses that edges join, ascending
};

struct OptimizedGraph {
  std::vector<Pose> poses;  ///< world_from_scan
  /// Of small motions [translation, rotation] of each pose in its own frame, m and rad, if the
  /// fixed poses are right. Empty if not asked for, or if the edges do not determine all poses.
  std::vector<Matrix6d> covariances;
  GraphQuality quality;
};

/// The same in the plane; motions are (x, y, heading).
struct OptimizedPlanarGraph {
  std::vector<PlanarPose> poses;
  std::vector<Eigen::Matrix3d> covariances;
  GraphQuality quality;
};

/// The poses that agree best with the edges of a graph, loops that contradict the rest left out;
/// errors are those of g2o, with rotations in radians (see SpatialManifold). Poses that are not
/// finite are unknown and come from the edges. Parts that no edge joins are optimized each by
/// itself. Throws Error if an edge joins poses that are not there or is not finite, if a fixed pose
/// is not there or not finite, or a parameter is out of range.
OptimizedGraph optimize(const PoseGraph& graph, const GraphParams& params = {},
                        const Progress& progress = {});
OptimizedPlanarGraph optimize(const PlanarPoseGraph& graph, const GraphParams& params = {},
                              const Progress& progress = {});

}  // namespace planum
