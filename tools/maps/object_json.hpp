#pragma once

#include <span>

#include <nlohmann/json_fwd.hpp>

#include "labeling/objects/scene_object.hpp"
#include "labeling/rooms/rooms.hpp"

namespace planum {

/// The list `objects` of polygons.json and report.json.
nlohmann::ordered_json objects_json(std::span<const SceneObject> objects, const RoomMap& rooms);

}  // namespace planum
