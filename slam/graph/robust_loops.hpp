#pragma once

#include <cstddef>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/graph_solver.hpp"

namespace planum {

struct RobustParams {
  /// Standard deviations, one-sided: a loop is wrong that contradicts the rest more than a right
  /// one would in all but a share of cases; 2.33 is 1 of 100.
  double gate = 2.33;
  double noise_scale = 0;  ///< true noise / noise that the information claims; 0: estimated
  int max_stages = 40;     ///< rounds of adding and removing loops
  int max_trials = 32;  ///< rejected loops that are tried against the result; fewer in big graphs
};

/// Which loops of a graph go together with odometry and with each other.
template <class Manifold>
struct LoopChoice {
  std::vector<double> weights;  ///< one an edge: 1 counts, 0 does not
  std::vector<typename Manifold::PoseType> poses;
  double noise_scale = 1;
  int systems = 0;  ///< solved on the way
};

/// Chooses loops so that the truncated least squares cost is small: the squared errors of all that
/// count plus a constant for each loop that does not. Odometry always counts. Loops are added in
/// the order of their uncertainty, those first that odometry predicts best, and are judged by their
/// innovation against all others that count, which comes for all loops at once from one selected
/// inversion; see docs/graph.md for how and why. The scale of the noise is estimated from the
/// loops, of which more than half must be right; information that is merely too modest does no
/// harm.
template <class Manifold>
LoopChoice<Manifold> consistent_loops(const typename Manifold::GraphType& graph,
                                      const GraphTerms& terms, const RobustParams& params,
                                      const Progress& progress = {});

}  // namespace planum
