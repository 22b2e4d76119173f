#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// What an edge may be off beyond its covariance; as LoopParams has it.
struct EdgeNoise {
  double translation = 0.02;        ///< m
  double rotation = radians(0.25);  ///< rad
};

/// How far an edge is from what poses say.
struct EdgeResidual {
  double translation = 0;  ///< m
  double rotation = 0;     ///< rad
  double deviations = 0;   ///< standard deviations of the edge (its information, and the noise)
};

/// Of any edge, accepted or not. Directions about which the edge has no information count for
/// nothing in `deviations`.
EdgeResidual edge_residual(const Edge& edge, const std::vector<Pose>& poses,
                           const EdgeNoise& noise = {});

struct HeldOutParams {
  std::size_t folds = 5;  ///< loops are left out a fifth at a time; not less than 2
  EdgeNoise noise = {};
};

struct HeldOutLoops {
  /// For each edge of the graph, where it is an accepted loop and the rest of the graph joins its
  /// poses: its residual with the poses that the graph has without it.
  std::vector<std::optional<EdgeResidual>> residuals;
  std::size_t solved = 0;     ///< graphs
  std::size_t converged = 0;  ///< of them
};

/// Cross-validation of loops: every accepted loop is foretold by a graph that knows nothing of it.
/// With as many folds as loops each is left out alone; else every folds-th loop goes together, in
/// the order of the edges. Throws Error as optimize() does, and for fewer than two folds.
HeldOutLoops held_out_loops(const PoseGraph& graph, const HeldOutParams& params = {},
                            const Progress& progress = {});

}  // namespace planum
