#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/graph/block_fronts.hpp"

namespace planum {

/// The values of a symmetric matrix of square blocks; each block column by column.
struct BlockMatrix {
  int block_size = 6;
  std::vector<double> diagonal;      ///< one block a row
  std::vector<double> off_diagonal;  ///< one block a pair: (first, second) of the pair

  void set_zero();
};

/// Sparse Cholesky factorization of a symmetric positive definite matrix of square blocks (2x2 to
/// 6x6): multifrontal (Duff & Reid 1983), analysed once for many matrices of one pattern. The same
/// bits for any number of threads.
class BlockCholesky {
 public:
  /// `pairs`: the off-diagonal blocks, each once.
  BlockCholesky(std::size_t blocks, int block_size, std::span<const BlockPair> pairs);

  /// A zero matrix of the pattern.
  BlockMatrix matrix() const;

  /// False if the matrix is not positive definite to working precision; then there is no factor.
  bool factorize(const BlockMatrix& matrix);

  /// Solves for each column. Only after a successful factorize().
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;

  /// The diagonal blocks of the inverse (Takahashi's recursion, front by front). Only after a
  /// successful factorize().
  std::vector<Eigen::MatrixXd> inverse_diagonal() const;

 private:
  bool factorize_front(std::size_t f, const BlockMatrix& matrix);
  void assemble(std::size_t f, const BlockMatrix& matrix);
  template <int B>
  void add_update(std::size_t child);

  std::size_t blocks_;
  int block_size_;
  std::size_t pair_count_;
  FrontTree tree_;
  std::vector<std::size_t> panel_begin_;  ///< of each front in panels_
  std::vector<double> panels_;            ///< the factor: of each front its columns, all rows
  std::vector<std::unique_ptr<double[]>> updates_;  ///< what fronts leave to their parents
};

}  // namespace planum
