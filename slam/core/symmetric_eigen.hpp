#pragma once

#include <Eigen/Core>

namespace planum {

/// Eigenvalues of a symmetric matrix, ascending, and their eigenvectors as columns.
template <int N>
struct SymmetricEigen {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<double, N, N> vectors;
};

/// For N = 3 and 6.
template <int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& matrix);

}  // namespace planum
