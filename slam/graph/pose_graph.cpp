#include "slam/graph/pose_graph.hpp"

#include <algorithm>
#include <numeric>

namespace planum {

PoseGraph pose_graph(const SequenceMatch& sequence) {
  PoseGraph graph{.poses = sequence.poses, .edges = {}};
  for (std::size_t i = 0; i < sequence.steps.size(); ++i) {
    const SequenceStep& step = sequence.steps[i];
    graph.edges.push_back({.from = i,
                           .to = i + 1,
                           .from_from_to = step.alignment.target_from_source,
                           .information = step.alignment.information,
                           .odometry_information = step.odometry_information,
                           .rms = step.alignment.rms,
                           .overlap = step.alignment.overlap,
                           .kind = EdgeKind::odometry,
                           .matched = step.matched,
                           .reason = step.reason});
  }
  return graph;
}

Vector6d edge_error(const Edge& edge, const std::vector<Pose>& poses) {
  return log_se3(edge.from_from_to.inverse() * poses[edge.from].inverse() * poses[edge.to]);
}

std::vector<std::vector<std::size_t>> Components::members() const {
  std::vector<std::vector<std::size_t>> result(count);
  for (std::size_t i = 0; i < of_pose.size(); ++i) result[of_pose[i]].push_back(i);
  return result;
}

std::vector<std::size_t> first_connected(
    std::size_t count, std::span<const std::pair<std::size_t, std::size_t>> pairs) {
  // Each thing points to a lower one that it is connected with, or to itself.
  std::vector<std::size_t> parent(count);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto first = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto& [a, b] : pairs) {
    const std::size_t first_a = first(a), first_b = first(b);
    parent[std::max(first_a, first_b)] = std::min(first_a, first_b);
  }
  for (std::size_t i = 0; i < count; ++i) parent[i] = first(i);
  return parent;
}

Components components(const PoseGraph& graph) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Edge& edge : graph.edges)
    if (edge.accepted && edge.matched) pairs.emplace_back(edge.from, edge.to);
  return components(graph.poses.size(), pairs);
}

Components components(std::size_t count,
                      std::span<const std::pair<std::size_t, std::size_t>> pairs) {
  const std::vector<std::size_t> first = first_connected(count, pairs);
  Components result{.of_pose = std::vector<std::size_t>(first.size()), .count = 0};
  for (std::size_t i = 0; i < first.size(); ++i)
    result.of_pose[i] = first[i] == i ? result.count++ : result.of_pose[first[i]];
  return result;
}

}  // namespace planum
