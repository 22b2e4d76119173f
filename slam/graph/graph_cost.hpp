#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/graph/gravity.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum {

/// A pose that does not move, or only tilts.
struct Anchor {
  std::size_t pose = 0;
  bool may_tilt = false;  ///< in space only: may turn about level axes
};

/// What there is beside the edges of a graph.
struct GraphTerms {
  RotationError rotation_error = RotationError::chord;
  std::vector<Anchor> anchors{};                  ///< at least one pose of each component
  std::vector<GravityObservation> gravity{};      ///< in space only; up_in_pose must be unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the world, unit
};

/// e' I e of each edge.
template <class Manifold>
std::vector<double> squared_errors(const typename Manifold::GraphType& graph,
                                   const GraphTerms& terms,
                                   std::span<const typename Manifold::PoseType> poses);

/// The weighted sum of them, plus that of gravity. Edges of weight 0 do not count.
template <class Manifold>
double graph_cost(const typename Manifold::GraphType& graph, const GraphTerms& terms,
                  std::span<const typename Manifold::PoseType> poses,
                  std::span<const double> weights);

}  // namespace planum
