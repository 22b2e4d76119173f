#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/graph/graph_solver.hpp"

namespace planum {

/// Poses along a spanning forest of the odometry edges of a graph, and how uncertain they are along
/// it. Gives the innovation of every loop against odometry alone without a system to solve.
template <class Manifold>
class OdometryTree {
 public:
  using Graph = typename Manifold::GraphType;
  using PoseType = typename Manifold::PoseType;
  using Matrix = typename Manifold::Matrix;

  /// Anchors are roots where they can be; roots keep the poses that they have in the graph. Edges
  /// that are not accepted do not count.
  OdometryTree(const Graph& graph, std::span<const Anchor> anchors);

  const std::vector<PoseType>& poses() const { return poses_; }
  bool connects(std::size_t a, std::size_t b) const { return root_[a] == root_[b]; }

  /// Of an edge that is not part of the tree. Not connected: 0 and an infinite gain.
  Innovation innovation(const typename Manifold::EdgeType& edge,
                        RotationError rotation_error) const;

 private:
  void grow_from(std::size_t root, const Graph& graph,
                 const std::vector<std::vector<std::size_t>>& edges_at);
  void add(const typename Manifold::EdgeType& edge, std::size_t child);
  std::size_t meeting(std::size_t a, std::size_t b) const;

  std::vector<PoseType> poses_;
  std::vector<Matrix> covariance_;  ///< of motions of the world at its origin, from the root on
  std::vector<std::size_t> parent_, depth_, root_;
};

}  // namespace planum
