#include "slam/graph/elch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/graph/path_covariance.hpp"

namespace planum {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
/// m^2; an edge whose information is singular says this little.
constexpr double unsure = 1e4;

struct Way {
  std::size_t to;
  double length;  ///< m^2, variance that the edge adds
};

double length_of(const Edge& edge) {
  const std::optional<Matrix6d> covariance = covariance_of(edge.information);
  if (!covariance) return unsure;
  const double length = uncertainty(*covariance);
  return std::isfinite(length) ? std::min(length, unsure) : unsure;
}

/// The ways that lead farther from a start, nearest first.
struct Tree {
  std::vector<double> distance;          ///< m^2; infinite where no way leads
  std::vector<std::size_t> parent;       ///< none at the start
  std::vector<std::size_t> by_distance;  ///< reached poses
};

Tree shortest_ways(const std::vector<std::vector<Way>>& ways, std::size_t start) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Tree tree{.distance = std::vector<double>(ways.size(), infinite),
            .parent = std::vector<std::size_t>(ways.size(), none),
            .by_distance = {}};
  std::vector<bool> done(ways.size(), false);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  tree.distance[start] = 0;
  queue.emplace(0, start);
  while (!queue.empty()) {
    const std::size_t at = queue.top().second;
    queue.pop();
    if (done[at]) continue;
    done[at] = true;
    tree.by_distance.push_back(at);
    for (const Way& way : ways[at]) {
      const double there = tree.distance[at] + way.length;
      if (there >= tree.distance[way.to]) continue;
      tree.distance[way.to] = there;
      tree.parent[way.to] = at;
      queue.emplace(there, way.to);
    }
  }
  return tree;
}

/// The poses bent so that `end` comes to `goal`. Along the way each step is turned by the share of
/// the turn up to it, and what then is left of the shift is shared too; all else keeps its place
/// relative to the pose of the way where it branches off.
std::vector<Pose> bent(const std::vector<Pose>& poses, const Tree& tree, std::size_t end,
                       const Pose& goal) {
  std::vector<std::size_t> way;
  for (std::size_t at = end; at != none; at = tree.parent[at]) way.push_back(at);
  std::reverse(way.begin(), way.end());
  const auto share = [&](std::size_t at) {
    return tree.distance[end] > 0 ? tree.distance[at] / tree.distance[end] : 1;
  };
  const Eigen::AngleAxisd turn(goal.linear() * poses[end].linear().transpose());
  const auto turned = [&](std::size_t at) {
    return Eigen::AngleAxisd(share(at) * turn.angle(), turn.axis()).toRotationMatrix();
  };
  std::vector<Pose> result = poses;
  std::vector<bool> on_way(poses.size(), false);
  on_way[way.front()] = true;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const std::size_t before = way[k - 1], at = way[k];
    on_way[at] = true;
    result[at].linear() = turned(at) * poses[at].linear();
    result[at].translation() =
        result[before].translation() +
        turned(before) * (poses[at].translation() - poses[before].translation());
  }
  const Eigen::Vector3d left = goal.translation() - result[end].translation();
  for (const std::size_t at : way) result[at].translation() += share(at) * left;
  for (const std::size_t at : tree.by_distance)
    if (!on_way[at])
      result[at] = result[tree.parent[at]] * poses[tree.parent[at]].inverse() * poses[at];
  for (const std::size_t at : tree.by_distance) result[at] = orthonormalized(result[at]);
  return result;
}

}  // namespace

std::vector<Pose> elch(const PoseGraph& graph, double closed) {
  std::vector<Pose> poses = graph.poses;
  std::vector<std::vector<Way>> ways(poses.size());
  const auto join = [&](const Edge& edge) {
    const double length = length_of(edge);
    ways[edge.from].push_back({edge.to, length});
    ways[edge.to].push_back({edge.from, length});
  };
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    const Edge& edge = graph.edges[k];
    if (edge.from >= poses.size() || edge.to >= poses.size())
      throw Error(fmt::format("ELCH: edge {} joins poses {} and {}, but there are {} poses", k,
                              edge.from, edge.to, poses.size()));
    if (edge.accepted && edge.kind == EdgeKind::odometry) join(edge);
  }
  for (const Edge& loop : graph.edges) {
    if (!loop.accepted || loop.kind != EdgeKind::loop) continue;
    const Vector6d error = edge_error(loop, poses);
    const bool open = error.dot(loop.information * error) > closed * closed;
    const Tree tree = open ? shortest_ways(ways, loop.from) : Tree{};
    if (open && std::isfinite(tree.distance[loop.to])) {
      const Pose goal = poses[loop.from] * loop.from_from_to;
      poses = bent(poses, tree, loop.to, goal);
    }
    join(loop);
  }
  return poses;
}

}  // namespace planum
