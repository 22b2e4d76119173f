#include "meshing/voxel_blocks.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

std::vector<CellKey> random_cells(std::size_t count, int spread) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> at(-spread, spread);
  std::vector<CellKey> cells;
  for (std::size_t i = 0; i < count; ++i)
    cells.push_back(i % 17 == 0 ? no_cell : cell_key(at(random), at(random), at(random)));
  return cells;
}

TEST(VoxelBlocks, KeysKeepCells) {
  for (const auto& cell : {Eigen::Vector3i(0, 0, 0), Eigen::Vector3i(-1, 5, -700000),
                           Eigen::Vector3i(1000000, -1000000, 3)}) {
    const CellKey key = cell_key(cell.x(), cell.y(), cell.z());
    EXPECT_EQ(cell_of(key), cell);
    EXPECT_EQ(
        cell_of(block_of(key)) + Eigen::Vector3i(cell_in_block(key) % 8, cell_in_block(key) / 8 % 8,
                                                 cell_in_block(key) / 64),
        cell);
  }
}

TEST(VoxelBlocks, SortByCellKeepsInputOrderWithinACell) {
  for (const int spread : {3, 40, 3000}) {
    const auto cells = random_cells(50000, spread);
    const CellSort sorted = sort_by_cell(cells);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < cells.size(); ++i)
      if (cells[i] != no_cell) expected.push_back(i);
    std::stable_sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
      const auto order = [&](std::uint32_t i) {
        return std::pair(block_of(cells[i]), cell_in_block(cells[i]));
      };
      return order(a) < order(b);
    });
    EXPECT_EQ(sorted.order, expected);
    for (std::size_t b = 0; b < sorted.blocks.size(); ++b)
      for (std::uint32_t k = sorted.begin[b]; k < sorted.begin[b + 1]; ++k)
        EXPECT_EQ(block_of(cells[sorted.order[k]]), sorted.blocks.key(b));
  }
}

TEST(VoxelBlocks, FindsEveryBlockAndNoOther) {
  const BlockSet blocks({cell_key(8, 0, 0), cell_key(-8, 16, 0), cell_key(8, 0, 0)});
  EXPECT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks.key(blocks.find(cell_key(8, 0, 0))), cell_key(8, 0, 0));
  EXPECT_EQ(blocks.find(cell_key(0, 0, 0)), no_block);
  EXPECT_EQ(blocks.neighbourhood(cell_key(0, 0, 0))[14], blocks.find(cell_key(8, 0, 0)));
  EXPECT_EQ(BlockSet().find(0), no_block);
}

TEST(VoxelBlocks, LatticesAgreeAboutCells) {
  // Whatever the points are, cells begin at the same places.
  const std::vector<Eigen::Vector3f> near = {{1, 2, 3}}, far = {{101, -52, 33}};
  const Lattice a = lattice_around(near, 0.05), b = lattice_around(far, 0.05);
  const Eigen::Vector3d shift = (a.origin - b.origin) / (0.05 * 128);
  EXPECT_LT((shift - shift.array().round().matrix()).norm(), 1e-9);
}

TEST(VoxelBlocks, PointsTooFarAwayHaveNoCell) {
  const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {0.1f, 0, 0}, {1e9f, 0, 0}, {0, 5e4f, 0}};
  const Lattice lattice = lattice_around(points, 0.05);
  const auto cells = cell_keys(lattice, points);
  EXPECT_NE(cells[0], no_cell);
  EXPECT_EQ(cells[2], no_cell);
  EXPECT_NE(cells[3], no_cell);
}

TEST(VoxelBlocks, PointsThatAreNotFiniteAreAnError) {
  const std::vector<Eigen::Vector3f> points = {{0, 0, 0}, {0, 0, NAN}};
  EXPECT_THROW(cell_keys(lattice_around(points, 0.05), points), Error);
}

}  // namespace
}  // namespace planum
