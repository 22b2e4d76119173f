#include "slam/graph/graph_solver.hpp"

#include <algorithm>
#include <cmath>

#include "slam/core/parallel.hpp"
#include "slam/graph/best_positions.hpp"

namespace planum {
namespace {

/// Few enough for large graphs, and small ones need no second thread.
constexpr std::size_t edges_in_block = 3072;

}  // namespace

template <class Manifold>
GraphSolver<Manifold>::GraphSolver(const Graph& graph, const GraphPattern& pattern,
                                   GraphTerms terms)
    : graph_(&graph),
      pattern_(&pattern),
      terms_(std::move(terms)),
      cholesky_(pattern.tree, Manifold::dimension),
      hessian_(cholesky_.matrix()),
      gradient_(Manifold::dimension * static_cast<Eigen::Index>(graph.poses.size())),
      damping_scale_(gradient_.size()),
      edge_blocks_(graph.edges.size()) {
  for (const Anchor& anchor : terms_.anchors) anchor_poses_.push_back(anchor.pose);
}

template <class Manifold>
double GraphSolver<Manifold>::cost(Poses poses, Weights weights) const {
  return graph_cost<Manifold>(*graph_, terms_, poses, weights);
}

template <class Manifold>
auto GraphSolver<Manifold>::diagonal(std::size_t pose) -> Eigen::Map<Matrix> {
  return Eigen::Map<Matrix>(hessian_.diagonal.data() + pose * Matrix::SizeAtCompileTime);
}

template <class Manifold>
auto GraphSolver<Manifold>::edge_blocks(std::size_t i, Poses poses, double weight) const
    -> EdgeBlocks {
  const auto& edge = graph_->edges[i];
  const auto l = Manifold::linearized(poses[edge.from], poses[edge.to], edge.from_from_to,
                                      terms_.rotation_error);
  const Matrix information = weight * edge.information;
  const Matrix weighted_from = information * l.by_from, weighted_to = information * l.by_to;
  EdgeBlocks blocks;
  blocks.from_from.noalias() = l.by_from.transpose() * weighted_from;
  blocks.to_to.noalias() = l.by_to.transpose() * weighted_to;
  if (edge.from < edge.to)
    blocks.first_second.noalias() = l.by_from.transpose() * weighted_to;
  else
    blocks.first_second.noalias() = l.by_to.transpose() * weighted_from;
  blocks.from.noalias() = weighted_from.transpose() * l.error;
  blocks.to.noalias() = weighted_to.transpose() * l.error;
  return blocks;
}

template <class Manifold>
void GraphSolver<Manifold>::linearize(Poses poses, Weights weights) {
  const auto& edges = graph_->edges;
  parallel_for(edges.size(), edges_in_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (weights[i] > 0) edge_blocks_[i] = edge_blocks(i, poses, weights[i]);
  });
  hessian_.set_zero();
  gradient_.setZero();
  constexpr int n = Manifold::dimension;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (weights[i] <= 0) continue;
    const EdgeBlocks& blocks = edge_blocks_[i];
    diagonal(edges[i].from) += blocks.from_from;
    diagonal(edges[i].to) += blocks.to_to;
    hessian_.off_diagonal_block<Matrix>(pattern_->pair_of_edge[i]) += blocks.first_second;
    gradient_.segment<n>(n * static_cast<Eigen::Index>(edges[i].from)) += blocks.from;
    gradient_.segment<n>(n * static_cast<Eigen::Index>(edges[i].to)) += blocks.to;
  }
  add_gravity(poses);
  apply_anchors(poses);
  set_damping_scale();
}

/// The error is R^T up - up_in_pose; turning the pose by dr changes it by [R^T up] dr.
template <class Manifold>
void GraphSolver<Manifold>::add_gravity([[maybe_unused]] Poses poses) {
  if constexpr (Manifold::space == 3) {
    for (const GravityObservation& seen : terms_.gravity) {
      const Eigen::Vector3d up = poses[seen.pose].linear().transpose() * terms_.up;
      const Eigen::Matrix3d by_turn = skew(up);
      const double weight = 1 / (seen.sigma * seen.sigma);
      diagonal(seen.pose).template bottomRightCorner<3, 3>() +=
          weight * by_turn.transpose() * by_turn;
      gradient_.template segment<3>(6 * static_cast<Eigen::Index>(seen.pose) + 3) +=
          weight * by_turn.transpose() * (up - seen.up_in_pose);
    }
  }
}

/// The projection of small motions of an anchor to those it may make.
template <class Manifold>
auto GraphSolver<Manifold>::freedom(const Anchor& anchor, [[maybe_unused]] Poses poses) const
    -> Matrix {
  Matrix projection = Matrix::Zero();
  if constexpr (Manifold::space == 3) {
    const Eigen::Vector3d up = poses[anchor.pose].linear().transpose() * terms_.up;
    if (anchor.may_tilt)
      projection.template bottomRightCorner<3, 3>() =
          Eigen::Matrix3d::Identity() - up * up.transpose();
  }
  return projection;
}

/// Leaves of each anchor's rows and columns the part it is free in; the rest becomes an identity.
template <class Manifold>
void GraphSolver<Manifold>::apply_anchors(Poses poses) {
  constexpr int n = Manifold::dimension;
  std::vector<Matrix> projections;
  projections.reserve(terms_.anchors.size());
  std::vector<const Matrix*> freedom_of(graph_->poses.size(), nullptr);
  for (const Anchor& anchor : terms_.anchors) {
    const Matrix& p = projections.emplace_back(freedom(anchor, poses));
    freedom_of[anchor.pose] = &p;
    diagonal(anchor.pose) = (p * diagonal(anchor.pose) * p + Matrix::Identity() - p).eval();
    auto gradient = gradient_.segment<n>(n * static_cast<Eigen::Index>(anchor.pose));
    gradient = (p * gradient).eval();
  }
  for (std::size_t k = 0; k < pattern_->pairs.size(); ++k) {
    auto block = hessian_.off_diagonal_block<Matrix>(k);
    if (const Matrix* p = freedom_of[pattern_->pairs[k].first]) block = (*p * block).eval();
    if (const Matrix* p = freedom_of[pattern_->pairs[k].second]) block = (block * *p).eval();
  }
}

/// What damping is relative to: the diagonal, but nothing that is zero.
template <class Manifold>
void GraphSolver<Manifold>::set_damping_scale() {
  constexpr int n = Manifold::dimension;
  for (std::size_t pose = 0; pose < graph_->poses.size(); ++pose)
    damping_scale_.segment<n>(n * static_cast<Eigen::Index>(pose)) = diagonal(pose).diagonal();
  damping_scale_ = damping_scale_.cwiseMax(1e-3 * damping_scale_.mean());
}

template <class Manifold>
bool GraphSolver<Manifold>::factorize(double damping) {
  if (damping == 0) return cholesky_.factorize(hessian_);
  constexpr int n = Manifold::dimension;
  const std::vector<double> undamped = hessian_.diagonal;
  for (std::size_t pose = 0; pose < graph_->poses.size(); ++pose)
    diagonal(pose).diagonal() +=
        damping * damping_scale_.segment<n>(n * static_cast<Eigen::Index>(pose));
  const bool done = cholesky_.factorize(hessian_);
  hessian_.diagonal = undamped;
  return done;
}

template <class Manifold>
void GraphSolver<Manifold>::improve_positions(std::vector<PoseType>& poses, double& poses_cost,
                                              Weights weights) const {
  auto better = with_best_positions<Manifold>(*graph_, *pattern_, anchor_poses_, weights, poses,
                                              terms_.rotation_error);
  if (better.empty()) return;
  const double better_cost = cost(better, weights);
  if (!(better_cost < poses_cost)) return;
  poses = std::move(better);
  poses_cost = better_cost;
}

template <class Manifold>
Descent<Manifold> GraphSolver<Manifold>::descend(std::vector<PoseType> poses, Weights weights,
                                                 const DescentParams& params,
                                                 const Progress& progress) {
  constexpr int n = Manifold::dimension;
  const double negligible = 1e-16 * static_cast<double>(graph_->edges.size() + 1);
  Descent<Manifold> descent{.poses = std::move(poses)};
  descent.cost = cost(descent.poses, weights);
  double damping = 0, last_damping = 1e-6;
  bool moved = true;
  while (descent.iterations < params.max_iterations && damping < 1e12) {
    if (moved) linearize(descent.poses, weights);
    moved = false;
    ++descent.iterations;
    progress.report(static_cast<std::size_t>(descent.iterations),
                    static_cast<std::size_t>(params.max_iterations));
    if (!factorize(damping)) {
      damping = std::max(10 * damping, 1e-9);
      continue;
    }
    const Eigen::VectorXd step = -cholesky_.solve(gradient_);
    const double promised = damping * step.cwiseAbs2().dot(damping_scale_) - gradient_.dot(step);
    std::vector<PoseType> candidate(descent.poses.size());
    for (std::size_t i = 0; i < candidate.size(); ++i)
      candidate[i] =
          Manifold::moved(descent.poses[i], step.segment<n>(n * static_cast<Eigen::Index>(i)));
    double candidate_cost = cost(candidate, weights);
    const bool last = promised <= params.tolerance * descent.cost + negligible && damping < 1e-5;
    if (!last && !(descent.cost - candidate_cost > 0.5 * promised))
      improve_positions(candidate, candidate_cost, weights);
    const double gain = (descent.cost - candidate_cost) / promised;
    moved = last ? candidate_cost <= descent.cost : gain > 1e-3;
    if (moved) {
      descent.poses = std::move(candidate);
      descent.cost = candidate_cost;
    }
    descent.converged = last;
    if (last) break;
    // Nielsen 1999: the better the promise was kept, the less damping.
    if (moved)
      damping *= std::max(0.1, 1 - std::pow(2 * gain - 1, 3));
    else
      damping = damping > 0 ? 10 * damping : last_damping;
    if (damping > 0) last_damping = damping;
    if (damping < 1e-14) damping = 0;
  }
  return descent;
}

template class GraphSolver<SpatialManifold>;
template class GraphSolver<PlanarManifold>;

}  // namespace planum
