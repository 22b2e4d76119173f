#include "slam/core/symmetric_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace planum {

template <int N>
SymmetricEigen<N> symmetric_eigen(const Eigen::Matrix<double, N, N>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template SymmetricEigen<3> symmetric_eigen(const Eigen::Matrix<double, 3, 3>&);
template SymmetricEigen<6> symmetric_eigen(const Eigen::Matrix<double, 6, 6>&);

}  // namespace planum
