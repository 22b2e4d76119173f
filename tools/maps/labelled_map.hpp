#pragma once

#include "labeling/labels.hpp"
#include "labeling/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// All that a map for people and robots is made of; one label, and one room or none, a polygon.
struct LabelledMap {
  const PolygonMap& map;
  const Labels& labels;
  const RoomMap& rooms;
};

}  // namespace planum
