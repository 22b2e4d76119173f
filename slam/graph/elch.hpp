#pragma once

#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {

/// Explicit loop closing heuristic (Sprickerhof, Nuechter, Lingemann & Hertzberg, ECMR 2009): for
/// one accepted loop after another, the path between its ends is bent until the loop closes. Each
/// pose takes the share of the loop's error that the path's uncertainty up to it has of that of the
/// whole way; poses off the way follow the one where they branch off. Other than in the paper,
/// steps turn with the poses they start from before what is left of the shift is shared: an error
/// of heading bends the path instead of shearing it. No equations are solved, so that it is a fast
/// first step for errors of any size; what it returns is consistent with the last loop of each part
/// of the path, not with all. Loops that close within `closed` standard deviations already change
/// nothing. Throws Error if an edge joins poses that are not there.
std::vector<Pose> elch(const PoseGraph& graph, double closed = 3);

}  // namespace planum
