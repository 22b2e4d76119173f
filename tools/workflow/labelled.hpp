#pragma once

#include <vector>

#include "labeling/labels.hpp"
#include "labeling/objects/scene_object.hpp"
#include "labeling/rooms/rooms.hpp"

namespace planum {

/// What the polygons of a map mean, and what stands between them.
struct Labelled {
  Labels labels;
  RoomMap rooms;
  std::vector<SceneObject> objects;
};

}  // namespace planum
