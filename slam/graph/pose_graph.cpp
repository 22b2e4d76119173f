#include "slam/graph/pose_graph.hpp"

#include <numeric>

namespace planum {

Vector6d edge_error(const Edge& edge, const std::vector<Pose>& poses) {
  return log_se3(edge.from_from_to.inverse() * poses[edge.from].inverse() * poses[edge.to]);
}

std::vector<std::vector<std::size_t>> Components::members() const {
  std::vector<std::vector<std::size_t>> result(count);
  for (std::size_t i = 0; i < of_pose.size(); ++i) result[of_pose[i]].push_back(i);
  return result;
}

Components components(const PoseGraph& graph) {
  // Each pose points to a lower one of its component, or to itself.
  std::vector<std::size_t> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Edge& edge : graph.edges) {
    if (!edge.accepted || !edge.matched) continue;
    const std::size_t a = root(edge.from), b = root(edge.to);
    parent[std::max(a, b)] = std::min(a, b);
  }
  Components result{.of_pose = std::vector<std::size_t>(graph.poses.size()), .count = 0};
  for (std::size_t i = 0; i < parent.size(); ++i)
    result.of_pose[i] = root(i) == i ? result.count++ : result.of_pose[root(i)];
  return result;
}

}  // namespace planum
