#pragma once

#include "labeling/labels.hpp"
#include "labeling/occupancy.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

struct KeepoutParams {
  double max_step = 0.05;       ///< m, a robot drives up and down that much
  double stair_headroom = 2.0;  ///< m above the floor, stairs that begin higher are not in the way
  double max_slope = radians(20);  ///< of a floor, for its height over a cell
};

/// Where a robot on a storey's floor must not go though nothing stands there: on stairs and over
/// drop-offs, places where the only floor that was seen is lower. On the grid of the storey's
/// occupancy map: occupied is forbidden, free is floor, unknown is neither. The map must be level.
/// Throws Error if labels are not those of the map, and for parameters out of range.
OccupancyGrid keepout_mask(const PolygonMap& map, const Labels& labels, const OccupancyGrid& storey,
                           const KeepoutParams& params = {});

}  // namespace planum
