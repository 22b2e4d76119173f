#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

/// Square cells over the floor plan. The plan frame is the levelled world turned about "up" until
/// most walls run along its axes, and moved until the seen area starts at x = y = 0.
struct FloorGrid {
  Pose plan_from_world = Pose::Identity();
  double cell = 0.05;  ///< m
  int columns = 0;     ///< along x
  int rows = 0;        ///< along y

  std::size_t size() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  /// Of a coordinate (m) however far outside.
  int column_of(double x) const {
    return static_cast<int>(std::clamp(std::floor(x / cell), -1e9, 1e9));
  }
  int row_of(double y) const { return column_of(y); }
  int column(std::size_t index) const {
    return static_cast<int>(index % static_cast<std::size_t>(columns));
  }
  int row(std::size_t index) const {
    return static_cast<int>(index / static_cast<std::size_t>(columns));
  }
  Eigen::Vector2d centre(std::size_t index) const {
    return {(column(index) + 0.5) * cell, (row(index) + 0.5) * cell};
  }
  /// The cell of a point of the plan, or -1 outside.
  std::ptrdiff_t find(const Eigen::Vector2d& p) const {
    const int c = column_of(p.x()), r = row_of(p.y());
    return contains(c, r) ? static_cast<std::ptrdiff_t>(index(c, r)) : -1;
  }
};

/// One byte a cell: 0 or 1.
using CellMask = std::vector<std::uint8_t>;

/// The grid over what a levelled cloud with normals shows; stray points far from everything are
/// left outside. Empty (no cells) for a cloud without points. `cell` grows where the plan is so
/// large that it would need more than 2^26 cells.
FloorGrid make_floor_grid(const Cloud& cloud, double cell);

/// The part of the segment from a to b on a grid and the cells around it, as shares of its length;
/// nothing if it passes by. Liang & Barsky, A New Concept and Method for Line Clipping, ACM
/// Transactions on Graphics 3 (1984).
inline std::optional<std::pair<double, double>> part_on(const FloorGrid& grid,
                                                        const Eigen::Vector2d& a,
                                                        const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a, low = Eigen::Vector2d::Constant(-grid.cell);
  const Eigen::Vector2d high = grid.cell * Eigen::Vector2d(grid.columns + 1, grid.rows + 1);
  double begin = 0, end = 1;
  for (int k = 0; k < 2; ++k) {
    if (d[k] == 0 && (a[k] < low[k] || a[k] > high[k])) return std::nullopt;
    if (d[k] == 0) continue;
    const double to_low = (low[k] - a[k]) / d[k], to_high = (high[k] - a[k]) / d[k];
    begin = std::max(begin, std::min(to_low, to_high));
    end = std::min(end, std::max(to_low, to_high));
  }
  if (begin > end) return std::nullopt;
  return std::pair(begin, end);
}

/// Calls visit(index) for every cell that the segment touches, in order, clipped to the
/// grid. Amanatides & Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, Eurographics 1987.
template <typename Visit>
void for_each_cell_between(const FloorGrid& grid, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to, Visit&& visit) {
  const auto part = part_on(grid, from, to);
  if (!part) return;
  const Eigen::Vector2d a = part->first > 0 ? from + part->first * (to - from) : from;
  const Eigen::Vector2d b = part->second < 1 ? from + part->second * (to - from) : to;
  int column = grid.column_of(a.x()), row = grid.row_of(a.y());
  const int last_column = grid.column_of(b.x()), last_row = grid.row_of(b.y());
  const Eigen::Vector2d d = b - a;
  const int step_x = d.x() > 0 ? 1 : -1, step_y = d.y() > 0 ? 1 : -1;
  const double far = 1e30;
  const double delta_x = d.x() != 0 ? grid.cell / std::abs(d.x()) : far;
  const double delta_y = d.y() != 0 ? grid.cell / std::abs(d.y()) : far;
  const auto first = [&](double position, int at, int step, double extent) {
    return extent != 0 ? ((at + (step > 0 ? 1 : 0)) * grid.cell - position) / extent : far;
  };
  double next_x = first(a.x(), column, step_x, d.x());
  double next_y = first(a.y(), row, step_y, d.y());
  int left = std::abs(last_column - column) + std::abs(last_row - row);
  for (;; --left) {
    if (grid.contains(column, row)) visit(grid.index(column, row));
    if (left <= 0) return;
    if (next_x < next_y) {
      column += step_x;
      next_x += delta_x;
    } else {
      row += step_y;
      next_y += delta_y;
    }
  }
}

}  // namespace planum
