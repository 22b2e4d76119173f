#include "slam/sensor/random_building.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/sensor/furniture.hpp"
#include "slam/sensor/random_numbers.hpp"

namespace planum {
namespace {

/// A door as the robot sees it who drives along the corridor in x.
struct Entrance {
  Eigen::Vector2d door;  ///< m, centre in plan
  double side = 1;       ///< 1: the room lies to the left, -1: to the right
};

/// Adds a room beside the corridor, from x0 on; its wall to the corridor is at y = inner.
Entrance add_room(BuildingPlan& plan, double x0, double side, double inner, RandomNumbers& random) {
  const double length = random.uniform(3.6, 5.5);
  const double depth = random.uniform(3.0, 4.5);
  const double thickness = random.uniform(0.1, 0.25);
  const double near = inner + side * thickness;
  const double far = near + side * depth;
  const double x1 = x0 + length;
  RoomPlan room{.name = fmt::format("room {}", plan.rooms.size() + 1),
                .walls = {.outer = {{x0, near}, {x1, near}, {x1, far}, {x0, far}}},
                .height = random.uniform(2.5, 3.2)};
  const Eigen::Vector2d door(x0 + random.uniform(0.7, 1.0), inner + side * thickness / 2);
  plan.doors.push_back({.between = {"corridor", room.name},
                        .centre = door,
                        .width = random.uniform(0.8, 1.0),
                        .height = random.uniform(2.0, 2.1)});
  plan.windows.push_back({.room = room.name, .centre = {x0 + length / 2, far}});
  const std::array<std::vector<Box>, 3> furniture{
      table({x1 - 1.1, far - side * 1.0}, {1.2, 0.7}, random.uniform(0, pi)),
      chair({x1 - 0.6, near + side * 0.7}, random.uniform(0, 2 * pi)),
      cabinet({x0 + 0.3, far - side * 0.6}, {0.4, 1.0}, random.uniform(0.5, 2.1))};
  for (const auto& boxes : furniture)
    plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
  plan.rooms.push_back(std::move(room));
  return {door, side};
}

class Path {
 public:
  Path(double turn, RandomNumbers& random) : turn_(turn), random_(random) {}

  void stop(const Eigen::Vector2d& at, double heading) {
    const Eigen::Vector2d position = Eigen::Rotation2Dd(turn_) * at;
    const double pitch = radians(random_.uniform(-0.6, 0.6));
    const double roll = radians(random_.uniform(-0.6, 0.6));
    poses_.push_back(
        pose_from_xyz_ypr({position.x(), position.y(), 0.6}, turn_ + heading, pitch, roll));
    last_ = at;
  }

  /// Along the corridor to x, stopping at least every 2 m.
  void drive_to(double x, double y) {
    while (x - last_.x() > 2) stop({last_.x() + 2, y}, 0);
    stop({x, y}, 0);
  }

  /// From the corridor into a room and out again, looking ahead along the corridor all the time.
  void visit(const Entrance& entrance) {
    stop(entrance.door, entrance.side * radians(25));
    stop(entrance.door + Eigen::Vector2d(0.5, entrance.side * 1.4), 0);
    stop(entrance.door, -entrance.side * radians(10));
  }

  const std::vector<Pose>& poses() const { return poses_; }

 private:
  double turn_;
  RandomNumbers& random_;
  Eigen::Vector2d last_ = Eigen::Vector2d::Zero();
  std::vector<Pose> poses_;
};

}  // namespace

RandomBuilding random_building(std::uint64_t seed, std::size_t rooms) {
  if (rooms == 0) throw Error("a building without rooms");
  RandomNumbers random({seed});
  const double width = random.uniform(1.5, 2.2);
  BuildingPlan plan{.name = fmt::format("random {}", seed), .turn = random.uniform(0, 2 * pi)};
  std::vector<Entrance> entrances;
  std::array<double, 2> row_end{0, 0};  // m, of the rooms to the right and to the left
  for (std::size_t i = 0; i < rooms; ++i) {
    const std::size_t row = i % 2;
    entrances.push_back(
        add_room(plan, row_end[row], row == 0 ? -1 : 1, row == 0 ? 0 : width, random));
    row_end[row] = plan.rooms.back().walls.outer[1].x() + random.uniform(0.1, 0.25);
  }
  const double length = std::max(row_end[0], row_end[1]);
  plan.rooms.push_back({.name = "corridor",
                        .walls = {{{0, 0}, {length, 0}, {length, width}, {0, width}}, {}},
                        .height = random.uniform(2.4, 2.8)});
  std::sort(entrances.begin(), entrances.end(),
            [](const Entrance& a, const Entrance& b) { return a.door.x() < b.door.x(); });
  Path path(plan.turn, random);
  path.stop({0.4, width / 2}, 0);
  for (const Entrance& entrance : entrances) {
    path.drive_to(entrance.door.x(), width / 2);
    path.visit(entrance);
  }
  path.drive_to(length - 0.7, width / 2);
  return {built(plan), path.poses()};
}

}  // namespace planum
