#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/graph/block_cholesky.hpp"
#include "slam/graph/graph_pattern.hpp"

namespace planum {

/// Linear least squares over one small block of unknowns a pose, some of them given.
template <int N>
class LinearSystem {
 public:
  using Block = Eigen::Matrix<double, N, N>;

  LinearSystem(const GraphPattern& pattern, Eigen::Index columns)
      : pattern_(pattern),
        cholesky_(pattern.tree, N),
        matrix_(cholesky_.matrix()),
        right_(Eigen::MatrixXd::Zero(N * static_cast<Eigen::Index>(pattern.tree->order.size()),
                                     columns)) {}

  auto diagonal(std::size_t pose) { return matrix_.diagonal_block<Block>(pose); }

  /// Rows of the lower of the two poses that the pair joins.
  auto off_diagonal(std::size_t pair) { return matrix_.off_diagonal_block<Block>(pair); }

  auto right(std::size_t pose) { return right_.middleRows<N>(N * static_cast<Eigen::Index>(pose)); }

  /// Solves with the unknowns of the anchors given (all others of `given` are not looked at); empty
  /// if the terms do not determine them all.
  std::optional<Eigen::MatrixXd> solved(std::span<const std::size_t> anchors,
                                        const Eigen::MatrixXd& given) {
    std::vector<bool> is_anchor(pattern_.tree->order.size(), false);
    for (const std::size_t anchor : anchors) is_anchor[anchor] = true;
    const auto of = [&](std::size_t pose) {
      return given.middleRows<N>(N * static_cast<Eigen::Index>(pose));
    };
    for (std::size_t k = 0; k < pattern_.pairs.size(); ++k) {
      const auto [first, second] = pattern_.pairs[k];
      if (!is_anchor[first] && !is_anchor[second]) continue;
      if (!is_anchor[second]) right(second) -= off_diagonal(k).transpose() * of(first);
      if (!is_anchor[first]) right(first) -= off_diagonal(k) * of(second);
      off_diagonal(k).setZero();
    }
    for (const std::size_t anchor : anchors) {
      diagonal(anchor).setIdentity();
      right(anchor) = of(anchor);
    }
    if (!cholesky_.factorize(matrix_)) return std::nullopt;
    return cholesky_.solve(right_);
  }

 private:
  const GraphPattern& pattern_;
  BlockCholesky cholesky_;
  BlockMatrix matrix_;
  Eigen::MatrixXd right_;
};

}  // namespace planum
