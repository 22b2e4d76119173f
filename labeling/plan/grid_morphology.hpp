#pragma once

#include <cstdint>
#include <vector>

#include "labeling/plan/floor_grid.hpp"

namespace planum {

/// For each cell the distance (in cells) to the nearest cell that is 0 in `mask`; cells beyond the
/// border count as 0. Felzenszwalb & Huttenlocher, Distance Transforms of Sampled Functions, 2012.
std::vector<float> distance_to_unset(const CellMask& mask, int columns, int rows);

/// Cells within `radius` (in cells) of a set cell.
CellMask dilated(const CellMask& mask, int columns, int rows, double radius);

/// Dilated, then eroded by the same radius: narrow gaps are filled.
CellMask closed(const CellMask& mask, int columns, int rows, double radius);

/// Connected cells (four neighbours) of a mask: their number and, for each cell, its component in
/// order of the first cell, or -1.
struct CellComponents {
  std::vector<std::int32_t> of_cell;
  std::vector<std::size_t> sizes;
};
CellComponents connected_components(const CellMask& mask, int columns, int rows);

/// Spreads the values >= 0 of `labels` to the cells of `mask`, step by step to four neighbours, at
/// most `max_steps` times; the lower label wins where two arrive together.
void spread_labels(std::vector<std::int32_t>& labels, const CellMask& mask, int columns, int rows,
                   int max_steps);

}  // namespace planum
