#pragma once

#include <vector>

#include <Eigen/Core>

namespace planum {

/// Signed area of a ring, positive if counter-clockwise.
double ring_area(const std::vector<Eigen::Vector2d>& ring);

/// Whether a point lies inside a ring.
bool ring_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p);

/// Whether a point lies inside a polygon: an outer ring, then its holes.
bool rings_contain(const std::vector<std::vector<Eigen::Vector2d>>& rings,
                   const Eigen::Vector2d& p);

/// The ring without slits and spikes: stretches of at most `max_steps` sides that come back to
/// within `width` (m) of where they left, and enclose less area than a slit of that width could.
std::vector<Eigen::Vector2d> without_slits(std::vector<Eigen::Vector2d> ring, double width,
                                           int max_steps = 4);

}  // namespace planum
