#pragma once

#include <cstdint>
#include <vector>

#include "labeling/plan/floor_grid.hpp"
#include "labeling/rooms/room_regions.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// The height range of a region, m.
struct RegionLevels {
  double floor = 0, ceiling = 0;
};

/// For each polygon the region that most of its free side looks into, or -1 where no region has
/// more than half of it.
std::vector<std::int32_t> regions_of_polygons(const PolygonMap& map, const FloorGrid& grid,
                                              const RoomRegions& regions,
                                              const std::vector<RegionLevels>& levels);

}  // namespace planum
