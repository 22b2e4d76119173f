#pragma once

#include <span>
#include <vector>

#include "labeling/rooms/rooms.hpp"

namespace planum {

/// The rooms of a building with several storeys, whose floors are at `floors` (m, lowest first; see
/// storey_floors): find_rooms for each storey on what is above its floor and below the next one,
/// with the scans that were taken there. Rooms are numbered over all storeys. What find_rooms
/// throws, this does too.
RoomMap find_rooms_of_storeys(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                              const PolygonMap& map, std::span<const double> floors,
                              const RoomParams& params = {});

}  // namespace planum
