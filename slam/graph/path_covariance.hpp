#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// m^2, one number for how unsure a covariance is, so that paths can be compared: a rotation of a
/// radian counts as 5 m.
double uncertainty(const Matrix6d& covariance);

/// How many standard deviations an error is.
double deviation(const Vector6d& error, const Matrix6d& covariance);

/// The inverse of information; none where that is not positive definite.
std::optional<Matrix6d> covariance_of(const Matrix6d& information);

/// How well the paths of accepted edges through a graph know relative poses. `step_noise` is added
/// to the covariance of every edge. Edges whose information is singular are no part of a path.
class PathCovariances {
 public:
  PathCovariances(const PoseGraph& graph, const Matrix6d& step_noise);

  /// Covariance of the error e of the relative pose start_from_scan * exp_se3(e) for every scan,
  /// along the path from `start` that knows it best; empty where no path leads.
  std::vector<std::optional<Matrix6d>> from(std::size_t start) const;

 private:
  struct Way {
    std::size_t to;
    Matrix6d covariance;      ///< of the way alone, in the frame where it ends
    Matrix6d end_from_start;  ///< adjoint
  };
  std::vector<std::vector<Way>> ways_;  ///< from each scan
};

}  // namespace planum
