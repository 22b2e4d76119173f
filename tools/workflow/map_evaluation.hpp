#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slam/core/progress.hpp"
#include "slam/evaluation/double_walls.hpp"
#include "slam/evaluation/map_sharpness.hpp"
#include "slam/graph/held_out_loops.hpp"
#include "tools/report/run_report.hpp"
#include "tools/workflow/results.hpp"

namespace planum {

struct MapEvaluationParams {
  MapSharpnessParams sharpness{.radius = 0.3, .max_points = 300'000, .max_queries = 5000};
  DoubleWallParams walls{};
  std::size_t patches = 4000;            ///< of double walls, shared by the loops; 0: all
  std::size_t loops_with_walls = 12;     ///< those with most scans between them; 0: all
  std::size_t points_per_scan = 20'000;  ///< for double walls, evenly chosen; 0: all
  HeldOutParams held_out{};
};

/// The same for a report that must not take long.
MapEvaluationParams quick_map_evaluation();

/// What a loop edge says about the poses of its scans.
struct LoopEvaluation {
  std::uint32_t from = 0, to = 0;  ///< numbers of the scans
  bool accepted = false;
  std::string reason;                    ///< why not
  EdgeResidual odometry, before, after;  ///< as the poses came, matched in order, relaxed
  std::optional<EdgeResidual> held_out;  ///< with poses of a graph that does not know the loop
};

/// How good a map is as far as can be said without a truth.
struct MapEvaluation {
  MapSharpness sharpness;
  std::vector<LoopEvaluation> loops;                        ///< in the order of the edges
  std::size_t held_out_solved = 0, held_out_converged = 0;  ///< graphs
  std::size_t loops_with_walls = 0;                         ///< loops that were looked at
  DoubleWallGap walls_before, walls_after;                  ///< over the patches of all of them
};

MapEvaluation evaluate_map(const World& world, const Cloud& cloud, const SequenceMatch& registered,
                           const PoseGraph& graph, const MapEvaluationParams& params = {},
                           const Progress& progress = {});

/// The part that a report names.
MapFigures map_figures(const MapEvaluation& evaluation);

}  // namespace planum
