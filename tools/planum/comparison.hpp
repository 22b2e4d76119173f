#pragma once

#include <string>

#include "labeling/rooms/rooms.hpp"
#include "slam/sensor/building.hpp"

namespace planum {

/// Rooms and doors of a map beside those of the building, as a table. A room or door is found if
/// one of the map is near it (1.5 m, 1 m).
std::string comparison_text(const Building& building, const RoomMap& map,
                            const Pose& building_from_world);

}  // namespace planum
