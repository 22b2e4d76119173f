#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// Covariance of the error e of the relative pose start_from_scan * exp_se3(e) for every scan,
/// along the path of accepted edges from `start` that knows it best; empty where no path leads.
/// `step_noise` is added to the covariance of every edge. Edges whose information is singular are
/// no part of a path.
std::vector<std::optional<Matrix6d>> path_covariances(const PoseGraph& graph, std::size_t start,
                                                      const Matrix6d& step_noise);

}  // namespace planum
