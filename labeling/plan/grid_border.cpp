#include "labeling/plan/grid_border.hpp"

#include <algorithm>
#include <array>

#include "labeling/plan/plan_ring.hpp"

namespace planum {

std::vector<Eigen::Vector2i> border_corners(const FloorGrid& grid,
                                            const std::vector<std::int32_t>& labels,
                                            std::int32_t label) {
  const auto inside = [&](const Eigen::Vector2i& c) {
    return grid.contains(c.x(), c.y()) && labels[grid.index(c.x(), c.y())] == label;
  };
  const auto first = std::find(labels.begin(), labels.end(), label);
  if (first == labels.end()) return {};
  const auto seed = static_cast<std::size_t>(first - labels.begin());
  const std::array<Eigen::Vector2i, 4> step{Eigen::Vector2i(1, 0), Eigen::Vector2i(0, 1),
                                            Eigen::Vector2i(-1, 0), Eigen::Vector2i(0, -1)};
  // Cells ahead of a corner, to the left and to the right of each direction.
  const std::array<Eigen::Vector2i, 4> left{Eigen::Vector2i(0, 0), Eigen::Vector2i(-1, 0),
                                            Eigen::Vector2i(-1, -1), Eigen::Vector2i(0, -1)};
  const std::array<Eigen::Vector2i, 4> right{Eigen::Vector2i(0, -1), Eigen::Vector2i(0, 0),
                                             Eigen::Vector2i(-1, 0), Eigen::Vector2i(-1, -1)};
  const Eigen::Vector2i start(grid.column(seed), grid.row(seed));
  std::vector<Eigen::Vector2i> corners;
  Eigen::Vector2i at = start;
  std::size_t direction = 0;  // below the first cell of the lowest row: the label is above
  do {
    corners.push_back(at);
    at += step[direction];
    if (!inside(at + left[direction]))
      direction = (direction + 1) % 4;
    else if (inside(at + right[direction]))
      direction = (direction + 3) % 4;
  } while (at != start || direction != 0);
  return corners;
}

void for_each_cell_inside(const FloorGrid& grid, const std::vector<Eigen::Vector2d>& ring,
                          const std::function<void(std::size_t)>& visit) {
  if (ring.empty()) return;
  Eigen::Vector2d low = ring.front(), high = ring.front();
  for (const Eigen::Vector2d& p : ring) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (int row = std::max(0, grid.row_of(low.y()));
       row <= std::min(grid.rows - 1, grid.row_of(high.y())); ++row)
    for (int column = std::max(0, grid.column_of(low.x()));
         column <= std::min(grid.columns - 1, grid.column_of(high.x())); ++column) {
      const std::size_t cell = grid.index(column, row);
      if (ring_contains(ring, grid.centre(cell))) visit(cell);
    }
}

}  // namespace planum
