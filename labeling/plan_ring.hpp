#pragma once

#include <vector>

#include <Eigen/Core>

namespace planum {

/// Signed area of a ring, positive if counter-clockwise.
double ring_area(const std::vector<Eigen::Vector2d>& ring);

/// Whether a point lies inside a ring.
bool ring_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p);

}  // namespace planum
