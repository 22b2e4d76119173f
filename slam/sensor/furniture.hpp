#pragma once

#include <vector>

#include "slam/sensor/building.hpp"

namespace planum {

/// Furniture as boxes that stand on the floor; `turn` (rad) is about z, sizes are length x width in
/// m. Length runs along x before the turn.

/// A top on four legs, 0.74 m high.
std::vector<Box> table(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double turn = 0);

/// Seat, four legs and a back at -x: who sits on it looks along x.
std::vector<Box> chair(const Eigen::Vector2d& centre, double turn = 0);

/// A closed block: a cupboard, a bed, a shelf full of books.
std::vector<Box> cabinet(const Eigen::Vector2d& centre, const Eigen::Vector2d& size, double height,
                         double turn = 0);

/// Seat, back at -y and two arms.
std::vector<Box> sofa(const Eigen::Vector2d& centre, double length, double turn = 0);

}  // namespace planum
