#pragma once

#include <Eigen/Core>

namespace planum {

/// An error e of information I beside a covariance P: with m = 1 + I P, (I^-1 + P)^-1 is m^-1 I,
/// which exists where I^-1 does not.
struct MixedError {
  double determinant;  ///< of m
  double squared;      ///< e' m^-1 I e, not below 0
};

/// `weighted` is I e. For N = 3 and 6.
template <int N>
MixedError mixed_error(const Eigen::Matrix<double, N, N>& m,
                       const Eigen::Matrix<double, N, 1>& error,
                       const Eigen::Matrix<double, N, 1>& weighted);

}  // namespace planum
