#include "labeling/plan/floor_grid.hpp"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace planum {
namespace {

using Eigen::Vector2d;

/// Between a segment and a cell, in cells; below 0 they overlap.
double clearance(const FloorGrid& grid, std::size_t cell, const Vector2d& a, const Vector2d& b) {
  // Separating axes: the two of the square, and the normal of the segment.
  const Vector2d middle = grid.centre(cell), d = b - a;
  const double half = grid.cell / 2;
  const double x =
      std::max(std::min(a.x(), b.x()) - middle.x(), middle.x() - std::max(a.x(), b.x()));
  const double y =
      std::max(std::min(a.y(), b.y()) - middle.y(), middle.y() - std::max(a.y(), b.y()));
  const Vector2d n = Vector2d(-d.y(), d.x()).normalized();
  const double across = std::abs(n.dot(middle - a)) - half * n.lpNorm<1>();
  return std::max({x - half, y - half, across}) / grid.cell;
}

void expect_walk(const FloorGrid& grid, const Vector2d& a, const Vector2d& b) {
  std::set<std::size_t> visited;
  for_each_cell_between(grid, a, b, [&](std::size_t cell) {
    EXPECT_TRUE(visited.insert(cell).second) << "a cell is visited twice";
  });
  const double rounding = 1e-9 + 1e-13 * (a - b).norm() / grid.cell;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const double clear = clearance(grid, cell, a, b);
    if (std::abs(clear) <= rounding) continue;
    EXPECT_EQ(visited.contains(cell), clear < 0) << a.transpose() << " to " << b.transpose();
  }
}

TEST(FloorGrid, WalksTheCellsThatASegmentTouches) {
  const FloorGrid grid{.cell = 0.05, .columns = 31, .rows = 17};
  std::mt19937 random(3);
  const auto point = [&](double margin) {
    std::uniform_real_distribution<double> x(-margin, 31 * 0.05 + margin),
        y(-margin, 17 * 0.05 + margin);
    const double px = x(random);
    return Vector2d(px, y(random));
  };
  for (int i = 0; i < 300; ++i) {
    expect_walk(grid, point(0), point(0));
    expect_walk(grid, point(0), point(3));
    expect_walk(grid, point(50), point(50));
    const Vector2d p = point(0.2);
    expect_walk(grid, p, {p.x() + 3, p.y()});
    expect_walk(grid, p, {p.x(), p.y() - 3});
  }
}

TEST(FloorGrid, WalksOnlyItsOwnPartOfASegmentThatEndsFarOutside) {
  const FloorGrid grid{.cell = 0.05, .columns = 31, .rows = 17};
  for (const double far : {1e4, 1e9, 1e15}) {
    expect_walk(grid, {0.71, 0.42}, {0.71 + far, 0.42 + far / 3});
    expect_walk(grid, {0.71, 0.42}, {0.71, 0.42 - far});
    expect_walk(grid, {-far, 0.42}, {far, 0.42});
    EXPECT_EQ(grid.find({far, 0.42}), -1);
    EXPECT_EQ(grid.find({0.71, -far}), -1);
  }
}

}  // namespace
}  // namespace planum
