#include "slam/graph/odometry_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "slam/graph/mixed_error.hpp"

namespace planum {
namespace {

constexpr std::size_t unseen = std::numeric_limits<std::size_t>::max();

/// The covariance that information stands for; directions without information get a large one.
template <class Matrix>
Matrix generous_covariance(Matrix information) {
  const double largest = information.diagonal().maxCoeff();
  information.diagonal().array() += largest > 0 ? 1e-9 * largest : 1.0;
  return information.inverse();
}

}  // namespace

template <class Manifold>
OdometryTree<Manifold>::OdometryTree(const Graph& graph, std::span<const Anchor> anchors)
    : poses_(graph.poses),
      covariance_(graph.poses.size(), Matrix::Zero()),
      parent_(graph.poses.size(), unseen),
      depth_(graph.poses.size(), 0),
      root_(graph.poses.size(), unseen) {
  std::vector<std::vector<std::size_t>> edges_at(graph.poses.size());
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    const auto& edge = graph.edges[i];
    if (!edge.accepted || edge.kind != EdgeKind::odometry) continue;
    edges_at[edge.from].push_back(i);
    edges_at[edge.to].push_back(i);
  }
  for (const Anchor& anchor : anchors) grow_from(anchor.pose, graph, edges_at);
  for (std::size_t pose = 0; pose < root_.size(); ++pose) grow_from(pose, graph, edges_at);
}

template <class Manifold>
void OdometryTree<Manifold>::grow_from(std::size_t root, const Graph& graph,
                                       const std::vector<std::vector<std::size_t>>& edges_at) {
  if (root_[root] != unseen) return;
  root_[root] = root;
  std::vector<std::size_t> open = {root};
  for (std::size_t next = 0; next < open.size(); ++next)  // breadth first: short paths
    for (const std::size_t i : edges_at[open[next]]) {
      const auto& edge = graph.edges[i];
      const std::size_t child = edge.from == open[next] ? edge.to : edge.from;
      if (root_[child] != unseen) continue;
      add(edge, child);
      open.push_back(child);
    }
}

/// With no error left, the motion of the child is that of the parent plus that of the edge, all as
/// motions of the world; the error of an edge is a motion of its `to` in the frame of that.
template <class Manifold>
void OdometryTree<Manifold>::add(const typename Manifold::EdgeType& edge, std::size_t child) {
  const std::size_t parent = edge.to == child ? edge.from : edge.to;
  parent_[child] = parent;
  depth_[child] = depth_[parent] + 1;
  root_[child] = root_[parent];
  poses_[child] = Manifold::product(
      poses_[parent], edge.to == child ? edge.from_from_to : Manifold::inverse(edge.from_from_to));
  const Matrix m = Manifold::world_from_own(poses_[edge.to]);
  covariance_[child] =
      covariance_[parent] + m * generous_covariance<Matrix>(edge.information) * m.transpose();
}

template <class Manifold>
std::size_t OdometryTree<Manifold>::meeting(std::size_t a, std::size_t b) const {
  while (a != b) {
    if (depth_[a] < depth_[b]) std::swap(a, b);
    a = parent_[a];
  }
  return a;
}

template <class Manifold>
Innovation OdometryTree<Manifold>::innovation(const typename Manifold::EdgeType& edge,
                                              RotationError rotation_error) const {
  Innovation result{.exact = true};
  if (!connects(edge.from, edge.to)) return result;
  const auto l =
      Manifold::linearized(poses_[edge.from], poses_[edge.to], edge.from_from_to, rotation_error);
  const Matrix path =
      covariance_[edge.from] + covariance_[edge.to] - 2 * covariance_[meeting(edge.from, edge.to)];
  const Matrix own_from_world = Manifold::world_from_own(Manifold::inverse(poses_[edge.to]));
  const Matrix by_world = l.by_to * own_from_world;
  const Matrix m = Matrix::Identity() + edge.information * (by_world * path * by_world.transpose());
  const MixedError mixed = mixed_error<Manifold::dimension>(m, l.error, edge.information * l.error);
  if (!(mixed.determinant > 0) || !std::isfinite(mixed.determinant)) return result;
  result.squared = mixed.squared;
  result.gain = 0.5 * std::log(mixed.determinant);
  return result;
}

template class OdometryTree<SpatialManifold>;
template class OdometryTree<PlanarManifold>;

}  // namespace planum
