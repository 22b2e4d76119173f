#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "tools/maps/octree_bricks.hpp"

namespace planum {

/// What one scan says of the cells of a brick; no cell is in both.
struct SeenBrick {
  BrickKey key;
  BrickSet occupied, free;
};

/// The cells of `cell` m that the points of a scan are in, and those that the rays from `origin` to
/// the middles of these pass. The same cells as those of OctoMap's computeDiscreteUpdate, which
/// walks as Amanatides & Woo 1987 do. Precondition: all within 2^15 - 1 cells from 0.
std::vector<SeenBrick> seen_cells(std::span<const Eigen::Vector3f> points,
                                  const Eigen::Vector3f& origin, double cell);

}  // namespace planum
