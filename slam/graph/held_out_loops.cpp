#include "slam/graph/held_out_loops.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/graph/graph_optimization.hpp"
#include "slam/graph/mixed_error.hpp"

namespace planum {
namespace {

std::vector<std::size_t> accepted_loops(const PoseGraph& graph) {
  std::vector<std::size_t> loops;
  for (std::size_t k = 0; k < graph.edges.size(); ++k)
    if (graph.edges[k].kind == EdgeKind::loop && graph.edges[k].accepted) loops.push_back(k);
  return loops;
}

/// The part of each pose, by accepted edges of any kind.
std::vector<std::size_t> parts_of(const PoseGraph& graph) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Edge& edge : graph.edges)
    if (edge.accepted) pairs.emplace_back(edge.from, edge.to);
  return first_connected(graph.poses.size(), pairs);
}

}  // namespace

EdgeResidual edge_residual(const Edge& edge, const std::vector<Pose>& poses,
                           const EdgeNoise& noise) {
  const Vector6d error = edge_error(edge, poses);
  const Vector6d variances =
      both_parts(noise.translation * noise.translation, noise.rotation * noise.rotation);
  const Matrix6d m = Matrix6d::Identity() + edge.information * variances.asDiagonal();
  const double squared = mixed_error<6>(m, error, edge.information * error).squared;
  return {.translation = error.head<3>().norm(),
          .rotation = error.tail<3>().norm(),
          .deviations = std::sqrt(squared)};
}

HeldOutLoops held_out_loops(const PoseGraph& graph, const HeldOutParams& params,
                            const Progress& progress) {
  if (params.folds < 2)
    throw Error(fmt::format("evaluation: folds must be >= 2, got {}", params.folds));
  HeldOutLoops result;
  result.residuals.resize(graph.edges.size());
  const std::vector<std::size_t> loops = accepted_loops(graph);
  const std::size_t folds = std::min(params.folds, loops.size());
  for (std::size_t fold = 0; fold < folds; ++fold) {
    PoseGraph rest = graph;
    for (std::size_t k = fold; k < loops.size(); k += folds) rest.edges[loops[k]].accepted = false;
    const OptimizedGraph solved =
        optimize(rest, {.rejection = LoopRejection::never, .covariances = false});
    ++result.solved;
    if (solved.quality.converged) ++result.converged;
    const std::vector<std::size_t> parts = parts_of(rest);
    for (std::size_t k = fold; k < loops.size(); k += folds) {
      const Edge& loop = graph.edges[loops[k]];
      if (parts[loop.from] == parts[loop.to])
        result.residuals[loops[k]] = edge_residual(loop, solved.poses, params.noise);
    }
    progress.report(fold + 1, folds);
  }
  return result;
}

}  // namespace planum
