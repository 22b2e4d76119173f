#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/graph/graph_pattern.hpp"
#include "slam/graph/pose_manifold.hpp"

namespace planum {

/// Poses from the edges alone, without a guess: rotations by linear least squares over all matrices
/// (the chordal relaxation: sum of weight |R_to - R_from R_measured|^2), each then projected to the
/// nearest rotation; with these, positions by linear least squares (Martinec & Pajdla, CVPR 2007;
/// Carlone et al., ICRA 2015). A global start for the optimizer: exact for perfect edges, close for
/// noisy ones.
/// `weights`: one an edge, 0 leaves it out; edges without information still connect. `anchors` keep
/// the poses they have in `graph`, whose other poses are not looked at. Empty if some poses are
/// connected to no anchor.
template <class Manifold>
std::vector<typename Manifold::PoseType> chordal_initialization(
    const typename Manifold::GraphType& graph, const GraphPattern& pattern,
    std::span<const std::size_t> anchors, std::span<const double> weights);

}  // namespace planum
