#include "labeling/plan/grid_morphology.hpp"

#include <random>

#include <gtest/gtest.h>

#include "labeling/plan/grid_border.hpp"
#include "labeling/plan/plan_ring.hpp"

namespace planum {
namespace {

constexpr int columns = 23, rows = 17;

std::size_t at(int x, int y) { return static_cast<std::size_t>(y * columns + x); }

CellMask random_mask(unsigned seed, double share) {
  std::mt19937 random(seed);
  std::bernoulli_distribution set(share);
  CellMask mask(static_cast<std::size_t>(columns * rows));
  for (std::uint8_t& cell : mask) cell = set(random);
  return mask;
}

/// Distance to the nearest cell that is not set, or beyond the border, by trying all.
double distance_by_trying(const CellMask& mask, int x, int y) {
  double best = 1e9;
  for (int v = -1; v <= rows; ++v)
    for (int u = -1; u <= columns; ++u) {
      const bool inside = u >= 0 && v >= 0 && u < columns && v < rows;
      if (!inside || !mask[at(u, v)]) best = std::min(best, std::hypot(u - x, v - y));
    }
  return best;
}

TEST(GridMorphology, DistanceAgreesWithTryingAll) {
  for (const double share : {0.2, 0.8, 0.97, 1.0}) {
    const CellMask mask = random_mask(1, share);
    const std::vector<float> distance = distance_to_unset(mask, columns, rows);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        EXPECT_NEAR(double{distance[at(x, y)]}, distance_by_trying(mask, x, y), 1e-5);
  }
}

TEST(GridMorphology, DilationSetsWhatIsNear) {
  const CellMask mask = random_mask(2, 0.02);
  const CellMask wide = dilated(mask, columns, rows, 3);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      bool near = false;
      for (int v = 0; v < rows; ++v)
        for (int u = 0; u < columns; ++u)
          near = near || (mask[at(u, v)] && std::hypot(u - x, v - y) <= 3);
      EXPECT_EQ(wide[at(x, y)] != 0, near);
    }
}

TEST(GridMorphology, ClosingFillsGapsAndKeepsWhatIsSet) {
  const CellMask mask = random_mask(3, 0.5);
  const CellMask result = closed(mask, columns, rows, 1.5);
  for (std::size_t i = 0; i < mask.size(); ++i) EXPECT_GE(result[i], mask[i]);
  CellMask slit(mask.size(), 1);
  for (int y = 0; y < rows; ++y) slit[at(10, y)] = slit[at(11, y)] = 0;
  EXPECT_EQ(closed(slit, columns, rows, 1), CellMask(mask.size(), 1));
  EXPECT_EQ(closed(CellMask(mask.size(), 0), columns, rows, 2), CellMask(mask.size(), 0));
}

TEST(GridMorphology, ComponentsHangTogetherBySides) {
  CellMask mask(static_cast<std::size_t>(columns * rows), 0);
  mask[at(2, 2)] = mask[at(3, 2)] = mask[at(4, 3)] = 1;
  const CellComponents parts = connected_components(mask, columns, rows);
  EXPECT_EQ(parts.sizes, (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ(parts.of_cell[at(3, 2)], 0);
  EXPECT_EQ(parts.of_cell[at(4, 3)], 1);
  EXPECT_EQ(parts.of_cell[at(0, 0)], -1);
}

TEST(GridMorphology, LabelsSpreadStepByStep) {
  CellMask mask(static_cast<std::size_t>(columns * rows), 1);
  std::vector<std::int32_t> labels(mask.size(), -1);
  labels[at(2, 5)] = 7;
  labels[at(8, 5)] = 3;
  spread_labels(labels, mask, columns, rows, 2);
  EXPECT_EQ(labels[at(4, 5)], 7);
  EXPECT_EQ(labels[at(5, 5)], -1);
  spread_labels(labels, mask, columns, rows, 1);
  EXPECT_EQ(labels[at(5, 5)], 3) << "the lower label where two arrive together";
}

TEST(GridBorder, EnclosesTheCells) {
  FloorGrid grid;
  grid.cell = 1;
  grid.columns = columns;
  grid.rows = rows;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const CellComponents parts = connected_components(random_mask(seed, 0.55), columns, rows);
    for (std::size_t p = 0; p < parts.sizes.size(); ++p) {
      const auto corners = border_corners(grid, parts.of_cell, static_cast<std::int32_t>(p));
      std::vector<Eigen::Vector2d> ring;
      for (const Eigen::Vector2i& c : corners) ring.push_back(c.cast<double>());
      // Holes are inside the outer border.
      EXPECT_GE(ring_area(ring), static_cast<double>(parts.sizes[p]));
      for (std::size_t cell = 0; cell < grid.size(); ++cell)
        EXPECT_TRUE(parts.of_cell[cell] != static_cast<std::int32_t>(p) ||
                    ring_contains(ring, grid.centre(cell)));
    }
  }
}

}  // namespace
}  // namespace planum
