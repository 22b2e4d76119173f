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

  /// One of the blocks, as a fixed-size Matrix.
  template <class Matrix>
  Eigen::Map<Matrix> diagonal_block(std::size_t k) {
    return Eigen::Map<Matrix>(diagonal.data() + k * Matrix::SizeAtCompileTime);
  }
  template <class Matrix>
  Eigen::Map<const Matrix> diagonal_block(std::size_t k) const {
    return Eigen::Map<const Matrix>(diagonal.data() + k * Matrix::SizeAtCompileTime);
  }
  template <class Matrix>
  Eigen::Map<Matrix> off_diagonal_block(std::size_t k) {
    return Eigen::Map<Matrix>(off_diagonal.data() + k * Matrix::SizeAtCompileTime);
  }
  template <class Matrix>
  Eigen::Map<const Matrix> off_diagonal_block(std::size_t k) const {
    return Eigen::Map<const Matrix>(off_diagonal.data() + k * Matrix::SizeAtCompileTime);
  }
};

/// Sparse Cholesky factorization of a symmetric positive definite matrix of square blocks (2x2 to
/// 6x6): multifrontal (Duff & Reid 1983), analysed once for many matrices of one pattern. The same
/// bits for any number of threads.
class BlockCholesky {
 public:
  /// The analysis may be shared. Blocks are 2x2, 3x3 or 6x6.
  BlockCholesky(std::shared_ptr<const FrontTree> tree, int block_size);

  /// A zero matrix of the pattern.
  BlockMatrix matrix() const;

  /// False if the matrix is not positive definite to working precision; then there is no factor.
  bool factorize(const BlockMatrix& matrix);

  /// Solves for each column. Only after a successful factorize().
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides) const;

  /// Those blocks of the inverse that are in the pattern of the matrix (Takahashi's recursion,
  /// front by front). Only after a successful factorize().
  BlockMatrix inverse() const;

 private:
  bool factorize_front(std::size_t f, const BlockMatrix& matrix);
  void assemble(std::size_t f, const BlockMatrix& matrix);
  Eigen::MatrixXd front_inverse(std::size_t f, const Eigen::MatrixXd& parent) const;
  template <int B>
  void add_update(std::size_t child);

  std::shared_ptr<const FrontTree> tree_;
  int block_size_;
  std::size_t subtrees_together_ = 1;     ///< that one thread takes; all, if the matrix is small
  std::vector<std::size_t> panel_begin_;  ///< of each front in panels_
  std::vector<double> panels_;            ///< the factor: of each front its columns, all rows
  std::vector<std::unique_ptr<double[]>> updates_;  ///< what fronts leave to their parents
};

}  // namespace planum
