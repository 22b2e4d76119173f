#pragma once

#include <cstdint>
#include <vector>

#include "labeling/plan/floor_grid.hpp"

namespace planum {

struct RoomRegionParams {
  double min_neck = 0.40;        ///< m, narrower connections part regions
  double fill_radius = 0.10;     ///< m, narrower gaps in the seen space are filled
  double min_half_width = 0.35;  ///< m, a region holds a disc of this radius
  double min_area = 1.0;         ///< m^2
};

/// The seen space split at walls: for each cell its region, or -1. Regions are numbered from the
/// largest to the smallest.
struct RoomRegions {
  std::vector<std::int32_t> of_cell;
  std::size_t count = 0;
};

/// `seen`: cells known to be open from floor to ceiling or at least crossed by a ray; `wall`: cells
/// that part rooms.
RoomRegions split_into_regions(const FloorGrid& grid, const CellMask& seen, const CellMask& wall,
                               const RoomRegionParams& params = {});

}  // namespace planum
