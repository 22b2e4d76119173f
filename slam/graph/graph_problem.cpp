#include "slam/graph/graph_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

template <class Manifold>
void check_edges(const typename Manifold::GraphType& graph) {
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const auto& edge = graph.edges[i];
    if (edge.from >= graph.poses.size() || edge.to >= graph.poses.size())
      throw Error(fmt::format("pose graph: edge {} joins poses {} and {}, but there are {} poses",
                              i, edge.from, edge.to, graph.poses.size()));
    if (edge.from == edge.to)
      throw Error(fmt::format("pose graph: edge {} joins pose {} with itself", i, edge.from));
    if (!Manifold::finite(edge.from_from_to) || !edge.information.allFinite())
      throw Error(fmt::format("pose graph: edge {} from pose {} to pose {} is not finite", i,
                              edge.from, edge.to));
  }
}

void check_range(const char* name, double value, double least) {
  if (!(value >= least))
    throw Error(fmt::format("pose graph: {} must be at least {}, got {}", name, least, value));
}

template <class Manifold>
void check_params(const typename Manifold::GraphType& graph, const GraphParams& params) {
  check_range("max_iterations", params.max_iterations, 0);
  check_range("tolerance", params.tolerance, 0);
  check_range("loop_gate", params.loop_gate, 0);
  for (const std::size_t pose : params.fixed) {
    if (pose >= graph.poses.size())
      throw Error(fmt::format("pose graph: pose {} is to stay fixed, but there are {} poses", pose,
                              graph.poses.size()));
    if (!Manifold::finite(graph.poses[pose]))
      throw Error(fmt::format("pose graph: pose {} is to stay fixed, but is not finite", pose));
  }
  if (Manifold::space == 2 && !params.gravity.empty())
    throw Error("pose graph: gravity says nothing about a graph in the plane");
  if (!(params.up.norm() > 0)) throw Error("pose graph: up must have a length");
  for (const GravityObservation& seen : params.gravity) {
    if (seen.pose >= graph.poses.size())
      throw Error(fmt::format("pose graph: gravity was seen from pose {}, but there are {} poses",
                              seen.pose, graph.poses.size()));
    if (!(seen.up_in_pose.norm() > 0) || !seen.up_in_pose.allFinite() || !(seen.sigma > 0))
      throw Error(
          fmt::format("pose graph: gravity as seen from pose {} has no direction or no "
                      "uncertainty",
                      seen.pose));
  }
}

bool holds(const std::vector<std::size_t>& all, std::size_t pose) {
  return std::find(all.begin(), all.end(), pose) != all.end();
}

}  // namespace

template <class Manifold>
GraphProblem<Manifold> graph_problem(const typename Manifold::GraphType& graph,
                                     const GraphParams& params) {
  check_edges<Manifold>(graph);
  check_params<Manifold>(graph, params);
  GraphProblem<Manifold> problem{.graph = graph};
  // As g2o has it: chi2 of a file is the same number here and there.
  problem.terms.rotation_error = Manifold::space == 3 ? RotationError::chord : RotationError::angle;
  problem.terms.up = params.up.normalized();
  problem.terms.gravity = params.gravity;
  for (GravityObservation& seen : problem.terms.gravity) seen.up_in_pose.normalize();
  for (auto& pose : problem.graph.poses) {
    problem.known.push_back(Manifold::finite(pose));
    if (!problem.known.back()) pose = Manifold::identity();
  }
  problem.repaired = repair_information(problem.graph);
  return problem;
}

template <class Manifold>
std::vector<std::vector<std::size_t>> joined_poses(const typename Manifold::GraphType& graph,
                                                   const std::vector<double>& weights) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    if (weights[i] > 0) pairs.emplace_back(graph.edges[i].from, graph.edges[i].to);
  return components(graph.poses.size(), pairs).members();
}

template <class Manifold>
std::vector<Anchor> anchors_of(const GraphProblem<Manifold>& problem, const GraphParams& params,
                               const std::vector<std::vector<std::size_t>>& parts) {
  std::vector<bool> is_fixed(problem.known.size(), false);
  std::vector<bool> sees_gravity(problem.known.size(), false);
  for (const std::size_t pose : params.fixed) is_fixed[pose] = true;
  for (const GravityObservation& seen : params.gravity) sees_gravity[seen.pose] = true;
  std::vector<Anchor> anchors;
  for (const auto& part : parts) {
    const std::size_t before = anchors.size();
    for (const std::size_t pose : part)
      if (is_fixed[pose]) anchors.push_back({.pose = pose});
    if (anchors.size() > before) continue;
    const auto known = std::find_if(part.begin(), part.end(),
                                    [&](std::size_t pose) { return problem.known[pose]; });
    const bool tilts =
        std::any_of(part.begin(), part.end(), [&](std::size_t pose) { return sees_gravity[pose]; });
    anchors.push_back({.pose = known == part.end() ? part.front() : *known, .may_tilt = tilts});
  }
  return anchors;
}

template <class Manifold>
void turn_upright([[maybe_unused]] const GraphProblem<Manifold>& problem,
                  [[maybe_unused]] const GraphParams& params,
                  [[maybe_unused]] const std::vector<std::vector<std::size_t>>& parts,
                  [[maybe_unused]] std::vector<typename Manifold::PoseType>& poses) {
  if constexpr (Manifold::space == 3) {
    if (problem.terms.gravity.empty()) return;
    for (const auto& part : parts) {
      const bool is_held = std::any_of(part.begin(), part.end(),
                                       [&](std::size_t pose) { return holds(params.fixed, pose); });
      Eigen::Vector3d seen_up = Eigen::Vector3d::Zero();
      for (const GravityObservation& seen : problem.terms.gravity)
        if (std::binary_search(part.begin(), part.end(), seen.pose))
          seen_up += poses[seen.pose].linear() * seen.up_in_pose / (seen.sigma * seen.sigma);
      if (is_held || !(seen_up.norm() > 0)) continue;
      const auto turn = turn_between(seen_up, problem.terms.up);
      for (const Anchor& anchor : problem.terms.anchors) {
        if (!std::binary_search(part.begin(), part.end(), anchor.pose)) continue;
        const Eigen::Vector3d pivot = poses[anchor.pose].translation();
        const Pose motion = Eigen::Translation3d(pivot) * turn * Eigen::Translation3d(-pivot);
        for (const std::size_t pose : part) poses[pose] = orthonormalized(motion * poses[pose]);
      }
    }
  }
}

template GraphProblem<SpatialManifold> graph_problem(const PoseGraph&, const GraphParams&);
template GraphProblem<PlanarManifold> graph_problem(const PlanarPoseGraph&, const GraphParams&);
template std::vector<std::vector<std::size_t>> joined_poses<SpatialManifold>(
    const PoseGraph&, const std::vector<double>&);
template std::vector<std::vector<std::size_t>> joined_poses<PlanarManifold>(
    const PlanarPoseGraph&, const std::vector<double>&);
template std::vector<Anchor> anchors_of(const GraphProblem<SpatialManifold>&, const GraphParams&,
                                        const std::vector<std::vector<std::size_t>>&);
template std::vector<Anchor> anchors_of(const GraphProblem<PlanarManifold>&, const GraphParams&,
                                        const std::vector<std::vector<std::size_t>>&);
template void turn_upright(const GraphProblem<SpatialManifold>&, const GraphParams&,
                           const std::vector<std::vector<std::size_t>>&, std::vector<Pose>&);
template void turn_upright(const GraphProblem<PlanarManifold>&, const GraphParams&,
                           const std::vector<std::vector<std::size_t>>&, std::vector<PlanarPose>&);

}  // namespace planum
