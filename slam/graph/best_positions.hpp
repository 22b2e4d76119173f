#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/graph/graph_pattern.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum {

/// The poses with the positions that minimize the weighted cost of the edges for their rotations: a
/// linear problem. `anchors` keep their positions. Where information is singular, positions are
/// held together by a billionth of the mean one. Empty if the edges do not connect all poses to
/// anchors.
template <class Manifold>
std::vector<typename Manifold::PoseType> with_best_positions(
    const typename Manifold::GraphType& graph, const GraphPattern& pattern,
    std::span<const std::size_t> anchors, std::span<const double> weights,
    std::span<const typename Manifold::PoseType> poses, RotationError rotation_error);

}  // namespace planum
