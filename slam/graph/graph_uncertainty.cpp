#include <cmath>

#include "slam/core/parallel.hpp"
#include "slam/graph/graph_solver.hpp"
#include "slam/graph/mixed_error.hpp"

namespace planum {

/// The inverse of the Hessian on the pattern; anchors do not vary but where they are free.
template <class Manifold>
BlockMatrix GraphSolver<Manifold>::anchored_inverse(Poses poses) const {
  BlockMatrix inverse = cholesky_.inverse();
  for (const Anchor& anchor : terms_.anchors) {
    const Matrix p = freedom(anchor, poses);
    auto block = inverse.diagonal_block<Matrix>(anchor.pose);
    block = (p * block * p).eval();
  }
  return inverse;
}

template <class Manifold>
auto GraphSolver<Manifold>::covariances(Poses poses, Weights weights) -> std::vector<Matrix> {
  linearize(poses, weights);
  if (!factorize(0)) return {};
  BlockMatrix inverse = anchored_inverse(poses);
  std::vector<Matrix> result;
  for (std::size_t pose = 0; pose < poses.size(); ++pose)
    result.emplace_back(inverse.diagonal_block<Matrix>(pose));
  return result;
}

/// With P, the covariance of the error that all counted edges leave to this one, S is I^-1 + P for
/// an edge that is not among them and I^-1 - P for one that is; (I^-1 +- P)^-1 = (1 +- I P)^-1 I.
template <class Manifold>
Innovation GraphSolver<Manifold>::innovation(std::size_t i, Poses poses, bool counted,
                                             const BlockMatrix& inverse) const {
  const auto& edge = graph_->edges[i];
  const auto l = Manifold::linearized(poses[edge.from], poses[edge.to], edge.from_from_to,
                                      terms_.rotation_error);
  Matrix p = l.by_from * inverse.diagonal_block<Matrix>(edge.from) * l.by_from.transpose() +
             l.by_to * inverse.diagonal_block<Matrix>(edge.to) * l.by_to.transpose();
  Innovation result;
  result.exact = pattern_->pair_of_edge[i] != GraphPattern::no_pair;
  if (result.exact) {
    Matrix across = inverse.off_diagonal_block<Matrix>(pattern_->pair_of_edge[i]);
    if (edge.from > edge.to) across.transposeInPlace();
    const Matrix mixed = l.by_from * across * l.by_to.transpose();
    p += mixed + mixed.transpose();
  } else {
    p *= 2;  // Cov(a + b) <= 2 Cov(a) + 2 Cov(b)
  }
  const Matrix m = Matrix::Identity() + (counted ? -1.0 : 1.0) * edge.information * p;
  const MixedError mixed = mixed_error<Manifold::dimension>(m, l.error, edge.information * l.error);
  // What only this edge joins has 1 - I P = 0, up to rounding.
  if (!(mixed.determinant > 1e-9)) return result;
  result.squared = mixed.squared;
  result.gain = 0.5 * std::abs(std::log(mixed.determinant));
  return result;
}

template <class Manifold>
std::vector<Innovation> GraphSolver<Manifold>::innovations(Poses poses, Weights weights) {
  linearize(poses, weights);
  std::vector<Innovation> result(graph_->edges.size());
  // A little damping stands for what no edge determines.
  if (!factorize(0) && !factorize(1e-9)) return result;
  const BlockMatrix inverse = anchored_inverse(poses);
  parallel_for(result.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result[i] = innovation(i, poses, weights[i] > 0, inverse);
  });
  return result;
}

template class GraphSolver<SpatialManifold>;
template class GraphSolver<PlanarManifold>;

}  // namespace planum
