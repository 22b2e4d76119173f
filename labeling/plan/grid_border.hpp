#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "labeling/plan/floor_grid.hpp"

namespace planum {

/// Corners of cells along the outer border of the cells with a label, which lie to the left of it
/// (counter-clockwise). The cells must hang together by their sides. Empty if there are none.
std::vector<Eigen::Vector2i> border_corners(const FloorGrid& grid,
                                            const std::vector<std::int32_t>& labels,
                                            std::int32_t label);

/// Calls visit(index) for the cells whose centres lie inside a ring.
void for_each_cell_inside(const FloorGrid& grid, const std::vector<Eigen::Vector2d>& ring,
                          const std::function<void(std::size_t)>& visit);

}  // namespace planum
