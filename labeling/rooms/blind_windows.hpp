#pragma once

#include "labeling/labels.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

struct BlindWindowParams {
  double min_sill = 0.3;    ///< m above the floor of the room
  double min_size = 0.4;    ///< m, width and height
  double min_fill = 0.6;    ///< of its rectangle, by the hole
  double max_depth = 0.7;   ///< m, of a reveal
  double edge_reach = 0.1;  ///< m, between the hole and the plane of a reveal
  double min_along = 0.3;   ///< of an edge, as far as its reveal was seen
  int min_reveals = 2;      ///< of the four edges
};

/// The rooms with windows that no ray came back through, so that find_rooms did not see them: holes
/// in wall polygons, or gaps between two jambs, above a sill, with reveals at two edges at least
/// and no surface that closes them. The map must be level. Throws Error if labels or rooms are not
/// those of the map.
RoomMap with_blind_windows(const PolygonMap& map, const Labels& labels, RoomMap rooms,
                           const BlindWindowParams& params = {});

}  // namespace planum
