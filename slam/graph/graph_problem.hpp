#pragma once

#include <cstddef>
#include <vector>

#include "slam/graph/graph_optimization.hpp"
#include "slam/graph/graph_solver.hpp"

namespace planum {

/// A graph that a GraphSolver can work on, and its anchors.
template <class Manifold>
struct GraphProblem {
  typename Manifold::GraphType graph;  ///< finite, information positive semidefinite
  std::vector<bool> known{};           ///< of each pose; the others were not finite
  GraphTerms terms{};
  std::vector<RepairedInformation> repaired{};
};

/// Checks and repairs. Throws Error as optimize() does.
template <class Manifold>
GraphProblem<Manifold> graph_problem(const typename Manifold::GraphType& graph,
                                     const GraphParams& params);

/// Poses that the edges of weight above 0 join, ascending, in the order of their first ones.
template <class Manifold>
std::vector<std::vector<std::size_t>> joined_poses(const typename Manifold::GraphType& graph,
                                                   const std::vector<double>& weights);

/// At least one anchor for each part: the fixed poses, or else the first one that is known. With
/// gravity that one may still tilt.
template <class Manifold>
std::vector<Anchor> anchors_of(const GraphProblem<Manifold>& problem, const GraphParams& params,
                               const std::vector<std::vector<std::size_t>>& parts);

/// Turns each part that is held by no fixed pose about its anchor so that up is where gravity
/// observations have it on average.
template <class Manifold>
void turn_upright(const GraphProblem<Manifold>& problem, const GraphParams& params,
                  const std::vector<std::vector<std::size_t>>& parts,
                  std::vector<typename Manifold::PoseType>& poses);

}  // namespace planum
