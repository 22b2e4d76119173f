#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/core/pose.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/furniture.hpp"

namespace planum::testing {

namespace ring {

inline constexpr double length = 30, width = 18, corridor = 2.0;  // m, the outer walls
inline constexpr double wall = 0.15;

inline PlanPolygon rectangle(double x0, double y0, double x1, double y1) {
  return {.outer = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

/// Four rooms south and four north of the ring; door x, and the side the room lies on.
struct Entrance {
  double x, y, outwards;
};

inline BuildingPlan plan_of(std::vector<Entrance>& entrances) {
  BuildingPlan plan{.name = "ring"};
  PlanPolygon ring = rectangle(0, 0, length, width);
  ring.holes.push_back(rectangle(corridor, corridor, length - corridor, width - corridor).outer);
  plan.rooms.push_back({"corridor", ring, 2.6});
  for (int k = 0; k < 8; ++k) {
    const bool south = k < 4;
    const double x0 = 0.5 + 7.3 * (k % 4), x1 = x0 + 6.2 + 0.2 * (k % 3);
    const double depth = 4.0 + 0.3 * k;
    const double near = south ? -wall : width + wall;
    const double far = south ? near - depth : near + depth;
    const std::string name = fmt::format("room {}", k + 1);
    plan.rooms.push_back(
        {name, rectangle(x0, std::min(near, far), x1, std::max(near, far)), 2.5 + 0.1 * (k % 4)});
    const double door = x0 + 1.2 + 0.5 * (k % 4), at = south ? -wall / 2 : width + wall / 2;
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
    plan.furniture.push_back({{4.0 + 5.3 * k, corridor - 0.15, 0}, {0.9, 0.3, 0.8 + 0.1 * k}});
    plan.furniture.push_back({{6.5 + 4.4 * k, width - corridor + 0.15, 0}, {0.6, 0.3, 1.2}});
  }
  return plan;
}

/// Round the ring counter-clockwise, into each room on the way, and a little past the start.
inline std::vector<Pose> path(const std::vector<Entrance>& entrances, double step,
                              std::size_t visits) {
  std::vector<Pose> poses;
  double x = corridor / 2, y = corridor / 2, heading = 0;
  const auto stop = [&](double to_x, double to_y, double degrees_of_heading) {
    x = to_x;
    y = to_y;
    heading = degrees_of_heading;
    poses.push_back(pose_from_xyz_ypr({x, y, 0.6}, radians(heading), 0, 0));
  };
  const auto drive = [&](double to_x, double to_y, double along) {
    const double way = std::hypot(to_x - x, to_y - y);
    const int steps = std::max(1, static_cast<int>(std::ceil(way / step)));
    const double from_x = x, from_y = y;
    for (int k = 1; k <= steps; ++k)
      stop(from_x + (to_x - from_x) * k / steps, from_y + (to_y - from_y) * k / steps, along);
  };
  const auto visit = [&](const Entrance& door, double along) {
    const double lane = door.outwards < 0 ? corridor / 2 : width - corridor / 2;
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
  for (std::size_t k = 0; k < std::min<std::size_t>(visits, 4); ++k) visit(entrances[k], 0);
  drive(length - corridor / 2, corridor / 2, 0);
  turn_left();
  drive(length - corridor / 2, width - corridor / 2, 90);
  turn_left();
  for (std::size_t k = std::min<std::size_t>(visits, 8); k > 4; --k) visit(entrances[k - 1], 180);
  drive(corridor / 2, width - corridor / 2, 180);
  turn_left();
  drive(corridor / 2, corridor / 2, 270);
  turn_left();
  drive(8, corridor / 2, 360);
  return poses;
}

}  // namespace ring

/// The building of sequence_benchmark and the path through it.
struct RingBuilding {
  Building building;
  std::vector<Pose> poses;
};

/// `step`: m, between stops in the corridor; `visits`: so many rooms are entered.
inline RingBuilding ring_building(double step = 2.2, std::size_t visits = 8) {
  std::vector<ring::Entrance> entrances;
  Building building = built(ring::plan_of(entrances));
  return {std::move(building), ring::path(entrances, step, visits)};
}

}  // namespace planum::testing
