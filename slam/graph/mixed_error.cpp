#include "slam/graph/mixed_error.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace planum {

template <int N>
MixedError mixed_error(const Eigen::Matrix<double, N, N>& m,
                       const Eigen::Matrix<double, N, 1>& error,
                       const Eigen::Matrix<double, N, 1>& weighted) {
  const Eigen::PartialPivLU<Eigen::Matrix<double, N, N>> lu(m);
  return {lu.determinant(), std::max(0.0, error.dot(lu.solve(weighted)))};
}

template MixedError mixed_error(const Eigen::Matrix<double, 3, 3>&,
                                const Eigen::Matrix<double, 3, 1>&,
                                const Eigen::Matrix<double, 3, 1>&);
template MixedError mixed_error(const Eigen::Matrix<double, 6, 6>&,
                                const Eigen::Matrix<double, 6, 1>&,
                                const Eigen::Matrix<double, 6, 1>&);

}  // namespace planum
