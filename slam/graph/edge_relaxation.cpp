#include "slam/graph/edge_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/graph/elch.hpp"

namespace planum {
namespace {

constexpr int max_iterations = 50;
/// m and rad; far below what any scanner sees.
constexpr double done_step = 1e-7;

/// Inverse of the right Jacobian of SE(3) near the identity: log(exp(e) exp(d)) ~ e + result * d.
/// Bernoulli series of the adjoint action of e, up to the fourth power.
Matrix6d inverse_right_jacobian(const Vector6d& e) {
  Matrix6d action = Matrix6d::Zero();
  action.topLeftCorner<3, 3>() = skew(e.tail<3>());
  action.bottomRightCorner<3, 3>() = skew(e.tail<3>());
  action.topRightCorner<3, 3>() = skew(e.head<3>());
  const Matrix6d squared = action * action;
  return Matrix6d::Identity() + action / 2 + squared / 12 - squared * squared / 720;
}

void check(const PoseGraph& graph) {
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Edge& edge = graph.edges[k];
    if (edge.from >= graph.poses.size() || edge.to >= graph.poses.size() || edge.from == edge.to)
      throw Error(fmt::format("relaxation: edge {} joins poses {} and {}, but there are {} poses",
                              k, edge.from, edge.to, graph.poses.size()));
    if (!edge.from_from_to.matrix().allFinite() || !edge.information.allFinite())
      throw Error(fmt::format("relaxation: edge {} from pose {} to pose {} is not finite", k,
                              edge.from, edge.to));
  }
  for (std::size_t i = 0; i < graph.poses.size(); ++i)
    if (!graph.poses[i].matrix().allFinite())
      throw Error(fmt::format("relaxation: pose {} is not finite", i));
}

double summed_error(const std::vector<Edge>& edges, const std::vector<Pose>& poses) {
  double sum = 0;
  for (const Edge& edge : edges) {
    const Vector6d e = edge_error(edge, poses);
    sum += e.dot(edge.information * e);
  }
  return sum;
}

}  // namespace

LinkEquation edge_equation(const Edge& edge, const Matrix6d& information,
                           const std::vector<Pose>& poses) {
  const Vector6d error = edge_error(edge, poses);
  // exp(x) moves `to` by exp(adjoint(to^-1) x) in its own frame.
  const Matrix6d jacobian = inverse_right_jacobian(error) * adjoint(poses[edge.to].inverse());
  const Matrix6d weighted = jacobian.transpose() * information;
  return {.a = edge.to,
          .b = edge.from,
          .information = weighted * jacobian,
          .weighted_difference = -weighted * error};
}

Vector6d gentle_damping() {
  constexpr double translation = 10, rotation = 1;
  return both_parts(1 / (translation * translation), 1 / (rotation * rotation));
}

EdgeRelaxation relax_edges(const PoseGraph& graph) {
  check(graph);
  EdgeRelaxation result{.poses = graph.poses};
  if (graph.poses.empty()) return result;
  std::vector<Edge> edges;
  std::vector<std::pair<std::size_t, std::size_t>> links;
  for (const Edge& edge : graph.edges)
    if (edge.accepted) {
      edges.push_back(edge);
      links.emplace_back(edge.to, edge.from);
    }
  // In the frame of the first pose, so that it does not matter where the world has its origin.
  const Pose world_from_first = graph.poses.front();
  for (Pose& pose : result.poses) pose = world_from_first.inverse() * pose;
  result.error_before = summed_error(edges, result.poses);
  if (std::vector<Pose> bent = elch({result.poses, edges});
      summed_error(edges, bent) < result.error_before)
    result.poses = std::move(bent);
  std::vector<bool> fixed(result.poses.size());
  const std::vector<std::size_t> first = first_connected(fixed.size(), links);
  for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = first[i] == i;
  LuMiliosSystem system(links, std::move(fixed));
  while (result.iterations < max_iterations && !result.converged) {
    std::vector<LinkEquation> equations;
    for (const Edge& edge : edges)
      equations.push_back(edge_equation(edge, edge.information, result.poses));
    const std::vector<Vector6d> motions = system.solve(equations, gentle_damping());
    double largest = 0;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Pose moved = orthonormalized(exp_se3(motions[i]) * result.poses[i]);
      largest = std::max({largest, (moved.translation() - result.poses[i].translation()).norm(),
                          motions[i].tail<3>().norm()});
      result.poses[i] = moved;
    }
    result.converged = largest < done_step;
    ++result.iterations;
  }
  result.error_after = summed_error(edges, result.poses);
  for (Pose& pose : result.poses) pose = world_from_first * pose;
  return result;
}

}  // namespace planum
