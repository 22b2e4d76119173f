#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace planum {

/// Where a cell of an octree of 16 levels is: columns, rows and layers from a corner of the tree.
using CellKey = std::array<std::uint16_t, 3>;

/// A brick is a node three levels above the cells, 8 x 8 x 8 of them: the key of a cell / 8.
using BrickKey = std::array<std::uint16_t, 3>;

inline constexpr std::size_t cells_per_brick = 512;
inline constexpr int bricks_levels = 13;  ///< from the root of the tree to a brick

/// Every third bit from the lowest: the share of one axis in a Morton number.
constexpr std::uint64_t spread(std::uint64_t number) {
  std::uint64_t result = 0;
  for (int i = 0; i < 16; ++i) result |= (number >> i & 1) << (3 * i);
  return result;
}

/// The path from the root of the tree to a brick, three bits a level: x, y, z from the lowest.
constexpr std::uint64_t path_of(const BrickKey& brick) {
  return spread(brick[0]) | spread(brick[1]) << 1 | spread(brick[2]) << 2;
}

/// A set of cells of a brick; a cell is named by the path from the brick to it.
class BrickSet {
 public:
  void add(std::size_t cell) { words_[cell / 64] |= std::uint64_t{1} << cell % 64; }
  bool has(std::size_t cell) const { return words_[cell / 64] >> cell % 64 & 1; }

  void add_all(const BrickSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
  }
  void remove_all(const BrickSet& other) {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
  }

  /// Whether one of the `count` (1, 8 or 64) cells from `cell`, a multiple of it, is in the set.
  bool has_any(std::size_t cell, std::size_t count) const {
    return (words_[cell / 64] >> cell % 64 & ~std::uint64_t{0} >> (64 - count)) != 0;
  }

  template <class Function>
  void for_each(const Function& function) const {
    for (std::size_t i = 0; i < words_.size(); ++i)
      for (std::uint64_t left = words_[i]; left != 0; left &= left - 1)
        function(64 * i + static_cast<std::size_t>(std::countr_zero(left)));
  }

 private:
  std::array<std::uint64_t, cells_per_brick / 64> words_ = {};
};

}  // namespace planum
