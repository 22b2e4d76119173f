#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// A cell of a cubic lattice as one number: 21 bits an axis, z above y above x.
using CellKey = std::uint64_t;
inline constexpr CellKey no_cell = ~CellKey{0};
inline constexpr int cell_limit = 1 << 20;  ///< cell coordinates are within [-limit, limit)

constexpr CellKey cell_key(int x, int y, int z) {
  return (CellKey(z + cell_limit) << 42) | (CellKey(y + cell_limit) << 21) |
         CellKey(x + cell_limit);
}
inline Eigen::Vector3i cell_of(CellKey key) {
  constexpr CellKey mask = (CellKey{1} << 21) - 1;
  return {int(key & mask) - cell_limit, int((key >> 21) & mask) - cell_limit,
          int((key >> 42) & mask) - cell_limit};
}

/// Cells of one size; cell (i, j, k) begins at origin + size * (i, j, k).
struct Lattice {
  double size = 0;                                   ///< m
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m

  /// no_cell where the point is too far from the origin.
  CellKey key(const Eigen::Vector3d& point) const;
};

/// A lattice whose origin is near the median of the points, at a multiple of 128 cells, so that
/// where cells lie does not depend on which points there are, and outliers cannot stretch it.
Lattice lattice_around(std::span<const Eigen::Vector3f> points, double size);

/// Throws Error if a point is not finite.
std::vector<CellKey> cell_keys(const Lattice& lattice, std::span<const Eigen::Vector3f> points);

/// Blocks of 8 x 8 x 8 cells: what is stored is what is occupied, so memory grows with surface.
inline constexpr int block_width = 8;
inline constexpr int block_cells = block_width * block_width * block_width;
inline constexpr std::uint32_t no_block = 0xffffffffu;
inline constexpr CellKey block_of(CellKey cell) {
  constexpr CellKey low = 7 | (CellKey{7} << 21) | (CellKey{7} << 42);
  return cell & ~low;
}
/// Where a cell is in its block: x + 8 y + 64 z.
inline constexpr int cell_in_block(CellKey cell) {
  return int((cell & 7) | ((cell >> 18) & 56) | ((cell >> 36) & 448));
}

/// A set of blocks, in ascending order of their keys (the key of a block is that of its first
/// cell).
class BlockSet {
 public:
  BlockSet() = default;
  explicit BlockSet(std::vector<CellKey> keys);  ///< in any order, repeated ones count once

  std::size_t size() const { return keys_.size(); }
  CellKey key(std::size_t block) const { return keys_[block]; }
  std::uint32_t find(CellKey block_key) const;  ///< no_block if it is not there
  /// The 27 blocks around and including one, x fastest; no_block where there is none.
  std::array<std::uint32_t, 27> neighbourhood(CellKey block) const;

 private:
  std::vector<CellKey> keys_;
  std::vector<std::uint32_t> table_;  ///< open addressing; no_block: empty
};

/// Things that lie in cells, in order of block, then cell in block, then input.
struct CellSort {
  BlockSet blocks;
  std::vector<std::uint32_t> order;  ///< positions in the input; those without a cell are left out
  std::vector<std::uint32_t> begin;  ///< per block its first place in `order`, and the end
};
CellSort sort_by_cell(std::span<const CellKey> cells);

/// The cells of one block and of a margin around it, x fastest: where in a list of things that is
/// sorted by cell (`cells`: those of the things; `begin`: per block) the things of a cell begin;
/// no_thing where there are none. Things of one cell follow each other.
inline constexpr std::uint32_t no_thing = 0xffffffffu;
void surrounding_cells(const BlockSet& blocks, std::span<const std::uint32_t> begin,
                       std::span<const CellKey> cells, CellKey block, int margin,
                       std::vector<std::uint32_t>& first);

}  // namespace planum
