#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace planum {

using Polyline = std::vector<Eigen::Vector3d>;  ///< m

/// Which vertices of a line to keep so that no other is farther than max_error (m) from the
/// simplified line (Douglas & Peucker 1973, with distances to segments). Several lines that are
/// walked in step, all of one length, are simplified together: a vertex stays if one of them needs
/// it. The ends are kept; of a closed line (last joined to first) two vertices far apart are.
/// Indices ascend. max_error 0 drops nothing but repeated points and points on straight segments.
std::vector<std::size_t> kept_vertices(std::span<const Polyline> lines, double max_error,
                                       bool closed = false);

/// One line simplified.
Polyline simplified(const Polyline& line, double max_error, bool closed = false);

}  // namespace planum
