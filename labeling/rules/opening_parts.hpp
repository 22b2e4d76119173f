#pragma once

#include <span>
#include <vector>

#include "labeling/labels.hpp"
#include "labeling/rooms/openings.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// Jambs, lintels, sills and panes: polygons that lie in the box of an opening, but for its floor.
/// Those of passages are `door` too. The map must be level.
void label_frames(const PolygonMap& map, std::span<const Opening> openings,
                  std::vector<PolygonLabel>& labels);

/// Leaves of open doors: upright polygons as high and as wide as a door that hang at one of its
/// jambs and that do not continue a wall.
void label_open_leaves(const PolygonMap& map, std::span<const Opening> openings,
                       std::vector<PolygonLabel>& labels);

}  // namespace planum
