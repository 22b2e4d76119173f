#include "slam/graph/path_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include <Eigen/Cholesky>

namespace planum {
double uncertainty(const Matrix6d& covariance) {
  constexpr double lever = 5;  // m
  return covariance.diagonal().head<3>().sum() +
         lever * lever * covariance.diagonal().tail<3>().sum();
}

double deviation(const Vector6d& error, const Matrix6d& covariance) {
  return std::sqrt(std::max(0.0, error.dot(covariance.ldlt().solve(error))));
}

std::optional<Matrix6d> covariance_of(const Matrix6d& information) {
  const Eigen::LLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  return factor.solve(Matrix6d::Identity());
}

PathCovariances::PathCovariances(const PoseGraph& graph, const Matrix6d& step_noise)
    : ways_(graph.poses.size()) {
  for (const Edge& edge : graph.edges) {
    if (!edge.accepted) continue;
    const std::optional<Matrix6d> own = covariance_of(edge.information);
    if (!own) continue;
    const Matrix6d covariance = *own + step_noise;
    const Matrix6d from_from_to = adjoint(edge.from_from_to);
    ways_[edge.from].push_back({edge.to, covariance, adjoint(edge.from_from_to.inverse())});
    ways_[edge.to].push_back(
        {edge.from, from_from_to * covariance * from_from_to.transpose(), from_from_to});
  }
}

std::vector<std::optional<Matrix6d>> PathCovariances::from(std::size_t start) const {
  std::vector<std::optional<Matrix6d>> result(ways_.size()), best(ways_.size());
  // Dijkstra; equal uncertainties in the order of the scans.
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  best[start] = Matrix6d::Zero();
  queue.emplace(0, start);
  while (!queue.empty()) {
    const std::size_t at = queue.top().second;
    queue.pop();
    if (result[at]) continue;
    result[at] = best[at];
    for (const Way& way : ways_[at]) {
      if (result[way.to]) continue;
      const Matrix6d there =
          way.end_from_start * *result[at] * way.end_from_start.transpose() + way.covariance;
      if (best[way.to] && uncertainty(*best[way.to]) <= uncertainty(there)) continue;
      best[way.to] = there;
      queue.emplace(uncertainty(there), way.to);
    }
  }
  return result;
}

}  // namespace planum
