#pragma once

#include "meshing/polygon_map.hpp"

namespace planum {

/// Closes lenses between polygons: where one polygon goes from u over m to w, another from w
/// straight to u, and neither a third polygon nor the rest has m, the triangle u m w is a sliver
/// that two simplifications of one border left. The polygon loses m, so that both share the edge.
/// Slivers of at least `max_area` (m^2) stay, and so do those without which a polygon would cross
/// itself. Vertices that nothing uses any more are left out.
void close_lenses(PolygonMap& map, double max_area);

}  // namespace planum
