#pragma once

#include <span>

#include "labeling/labels.hpp"
#include "labeling/objects/scene_object.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// All that a map for people and robots is made of; one label, and one room or none, a polygon.
struct LabelledMap {
  const PolygonMap& map;
  const Labels& labels;
  const RoomMap& rooms;
  std::span<const SceneObject> objects = {};
};

}  // namespace planum
