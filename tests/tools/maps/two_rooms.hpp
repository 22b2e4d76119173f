#pragma once

#include <algorithm>

#include "labeling/rooms/rooms.hpp"
#include "slam/core/pose.hpp"

namespace planum::testing {

/// Two rooms beside each other, 4 x 3 m and 2 x 3 m, with a door and a window, turned and moved.
inline RoomMap two_rooms(double yaw, const Eigen::Vector3d& shift) {
  const Pose place = pose_from_xyz_ypr(shift, radians(yaw), 0, 0);
  const auto room = [&](const char* name, double x, double size) {
    Room result;
    result.name = name;
    result.centre = place * Eigen::Vector3d(x + size / 2, 1.5, 1.25);
    result.along =
        place.linear() * (size > 3 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY());
    result.area = 3 * size;
    result.width = std::min(size, 3.0);
    result.depth = std::max(size, 3.0);
    result.height = 2.5;
    for (const Eigen::Vector3d& p :
         {Eigen::Vector3d(x, 0, 0), {x + size, 0, 0}, {x + size, 3, 0}, {x, 3, 0}})
      result.outline.push_back(place * p);
    return result;
  };
  RoomMap rooms;
  rooms.rooms = {room("kitchen & <more>", 0, 4), room("room 2", 4.2, 2)};
  Opening door, window;
  door.position = place * Eigen::Vector3d(4.1, 1.5, 1);
  door.across = place.linear() * Eigen::Vector3d::UnitX();
  door.width = 0.9;
  door.thickness = 0.2;
  door.rooms = {0, 1};
  window = door;
  window.kind = OpeningKind::window;
  window.position = place * Eigen::Vector3d(-0.1, 1.5, 1.5);
  window.rooms = {0};
  rooms.openings = {door, window};
  return rooms;
}

}  // namespace planum::testing
