#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/core/pose.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/furniture.hpp"

// A building whose corridor is a ring, with rooms that a robot enters and leaves.
namespace planum::testing {

inline constexpr double ring_length = 30, ring_width = 18, ring_corridor = 2.0;  // m, outer walls
inline constexpr double ring_wall = 0.15;                                        // m

inline PlanPolygon rectangle(double x0, double y0, double x1, double y1) {
  return {.outer = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

/// Of a room of the ring, four to the south and four to the north: where the door is, and on which
/// side the room lies.
struct Entrance {
  double x, y, outwards;
};

inline BuildingPlan ring_plan(std::vector<Entrance>& entrances) {
  BuildingPlan plan{.name = "ring"};
  PlanPolygon ring = rectangle(0, 0, ring_length, ring_width);
  ring.holes.push_back(rectangle(ring_corridor, ring_corridor, ring_length - ring_corridor,
                                 ring_width - ring_corridor)
                           .outer);
  plan.rooms.push_back({"corridor", ring, 2.6});
  for (int k = 0; k < 8; ++k) {
    const bool south = k < 4;
    const double x0 = 0.5 + 7.3 * (k % 4), x1 = x0 + 6.2 + 0.2 * (k % 3);
    const double depth = 4.0 + 0.3 * k;
    const double near = south ? -ring_wall : ring_width + ring_wall;
    const double far = south ? near - depth : near + depth;
    const std::string name = fmt::format("room {}", k + 1);
    plan.rooms.push_back(
        {name, rectangle(x0, std::min(near, far), x1, std::max(near, far)), 2.5 + 0.1 * (k % 4)});
    const double door = x0 + 1.2 + 0.5 * (k % 4),
                 at = south ? -ring_wall / 2 : ring_width + ring_wall / 2;
    plan.doors.push_back({{"corridor", name}, {door, at}, 0.9, 2.05});
    entrances.push_back({door, at, south ? -1.0 : 1.0});
    const auto add = [&](const std::vector<Box>& boxes) {
      plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
    };
    const double middle = (near + far) / 2;
    add(table({x1 - 1.2, middle}, {1.4, 0.8}, 0.3 * k));
    add(chair({x1 - 2.2, middle + 0.6}, 0.9 * k));
    add(cabinet({x0 + 0.3, middle}, {0.4, 1.2}, 1.0 + 0.15 * k));
  }
  for (int k = 0; k < 5; ++k) {  // something to hold on to in the corridor
    plan.furniture.push_back({{4.0 + 5.3 * k, ring_corridor - 0.15, 0}, {0.9, 0.3, 0.8 + 0.1 * k}});
    plan.furniture.push_back(
        {{6.5 + 4.4 * k, ring_width - ring_corridor + 0.15, 0}, {0.6, 0.3, 1.2}});
  }
  return plan;
}

/// Round the ring counter-clockwise, into each room on the way, and a little past the start.
inline std::vector<Pose> ring_path(const std::vector<Entrance>& entrances) {
  std::vector<Pose> poses;
  double x = ring_corridor / 2, y = ring_corridor / 2, heading = 0;
  const auto stop = [&](double to_x, double to_y, double degrees_of_heading) {
    x = to_x;
    y = to_y;
    heading = degrees_of_heading;
    poses.push_back(pose_from_xyz_ypr({x, y, 0.6}, radians(heading), 0, 0));
  };
  const auto drive = [&](double to_x, double to_y, double along) {
    const double way = std::hypot(to_x - x, to_y - y);
    const int steps = std::max(1, static_cast<int>(std::ceil(way / 2.2)));
    const double from_x = x, from_y = y;
    for (int k = 1; k <= steps; ++k)
      stop(from_x + (to_x - from_x) * k / steps, from_y + (to_y - from_y) * k / steps, along);
  };
  const auto visit = [&](const Entrance& door, double along) {
    const double lane = door.outwards < 0 ? ring_corridor / 2 : ring_width - ring_corridor / 2;
    const double side = (along == 0 ? 1 : -1) * door.outwards;
    drive(door.x - (along == 0 ? 0.8 : -0.8), lane, along);
    stop(door.x, door.y, along + 25 * side);
    stop(door.x + (along == 0 ? 0.6 : -0.6), door.y + door.outwards * 1.6, along);
    stop(door.x, door.y, along - 10 * side);
    stop(door.x + (along == 0 ? 0.8 : -0.8), lane, along);
  };
  const auto turn_left = [&] {
    for (int k = 0; k < 3; ++k) stop(x, y, heading + 30);
  };
  stop(x, y, 0);
  for (int k = 0; k < 4; ++k) visit(entrances[static_cast<std::size_t>(k)], 0);
  drive(ring_length - ring_corridor / 2, ring_corridor / 2, 0);
  turn_left();
  drive(ring_length - ring_corridor / 2, ring_width - ring_corridor / 2, 90);
  turn_left();
  for (int k = 7; k >= 4; --k) visit(entrances[static_cast<std::size_t>(k)], 180);
  drive(ring_corridor / 2, ring_width - ring_corridor / 2, 180);
  turn_left();
  drive(ring_corridor / 2, ring_corridor / 2, 270);
  turn_left();
  drive(8, ring_corridor / 2, 360);
  return poses;
}

}  // namespace planum::testing
