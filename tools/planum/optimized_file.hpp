#pragma once

#include <string>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/graph/graph_optimization.hpp"
#include "slam/io/g2o.hpp"

namespace planum {

/// A .g2o file with the poses that agree best with its edges.
struct OptimizedFile {
  /// All vertices by their ids, also those that had no pose; edges that count, with repaired
  /// information; rejected ones as comments.
  G2oGraph file;
  GraphQuality quality;       ///< poses and edges counted as in `ids` and in the given file
  std::vector<int> ids;       ///< of the poses
  double largest_sigma = -1;  ///< m, of any position along any direction; -1: not known
};

/// By optimize().
OptimizedFile optimized_pose_graph(const G2oGraph& file, GraphParams params,
                                   const Progress& progress);

/// By relax_edges(), from the better of the given poses and those of the edges. Loops are not
/// rejected. Throws Error if several fixed vertices hang together.
OptimizedFile relaxed_file(const G2oGraph& file);

}  // namespace planum
