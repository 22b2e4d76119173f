#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "tools/maps/octree_bricks.hpp"

namespace planum {

/// What is known of a brick's cells.
struct BrickOdds {
  std::uint64_t path = 0;  ///< from the root of the tree
  BrickSet known;
  std::array<float, cells_per_brick> log_odds = {};  ///< of being occupied; 0 where not known
};

/// A whole file of OctoMap (.ot): the octree with the log odds of its leaves. Eight leaves of the
/// same value are one. Precondition: bricks in the order of their paths, each with a known cell.
std::string octree_file(std::span<const BrickOdds* const> bricks, double cell);

/// The same as a binary file (.bt): leaves are occupied, if that is as likely as not, or free.
std::string binary_octree_file(std::span<const BrickOdds* const> bricks, double cell);

}  // namespace planum
