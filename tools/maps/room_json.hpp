#pragma once

#include <nlohmann/json_fwd.hpp>

#include "labeling/rooms/rooms.hpp"

namespace planum {

/// The `rooms` list of polygons.json and report.json.
nlohmann::ordered_json rooms_json(const RoomMap& rooms);

/// The `openings` list of polygons.json and report.json.
nlohmann::ordered_json openings_json(const RoomMap& rooms);

}  // namespace planum
