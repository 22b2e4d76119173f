#pragma once

#include <array>
#include <vector>

#include "meshing/voxel_blocks.hpp"

namespace planum {

/// The corners of all cells of a block: one more along each axis than it has cells.
inline constexpr int corner_width = block_width + 1;
inline constexpr std::size_t block_corners = corner_width * corner_width * corner_width;

constexpr std::size_t corner_index(int x, int y, int z) {
  return std::size_t((z * corner_width + y) * corner_width + x);
}

/// From a corner's place in a block of cells (cell_in_block) to its place among block_corners.
constexpr std::size_t corner_of_cell(std::size_t cell) {
  return corner_index(int(cell) % block_width, int(cell) / block_width % block_width,
                      int(cell) / (block_width * block_width));
}

/// From a corner to the next one along an axis.
inline constexpr std::array<std::size_t, 3> corner_step = {1, corner_width,
                                                           corner_width* corner_width};

/// A block and its seven neighbours that are `step` cells away along x (bit 0), y (1), z (2).
inline std::array<std::uint32_t, 8> octant_blocks(const BlockSet& blocks, CellKey block, int step) {
  const Eigen::Vector3i at = cell_of(block);
  std::array<std::uint32_t, 8> result;
  for (int k = 0; k < 8; ++k)
    result[std::size_t(k)] = blocks.find(
        cell_key(at.x() + (k & 1) * step, at.y() + (k >> 1 & 1) * step, at.z() + (k >> 2) * step));
  return result;
}

/// Reads values that are stored by lowest corner, block_cells a block, for all corners of a block.
template <class Value>
void read_corners(const BlockSet& blocks, const std::vector<Value>& values, CellKey block,
                  const Value& missing, std::array<Value, block_corners>& corners) {
  const auto owners = octant_blocks(blocks, block, block_width);
  for (int z = 0; z <= block_width; ++z)
    for (int y = 0; y <= block_width; ++y)
      for (int x = 0; x <= block_width; ++x) {
        const int octant = x / block_width | y / block_width << 1 | z / block_width << 2;
        const std::uint32_t owner = owners[std::size_t(octant)];
        const int cell =
            ((z % block_width) * block_width + y % block_width) * block_width + x % block_width;
        corners[corner_index(x, y, z)] =
            owner == no_block ? missing
                              : values[owner * std::size_t(block_cells) + std::size_t(cell)];
      }
}

}  // namespace planum
