#include "labeling/rooms/blind_windows.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/labeling/plans.hpp"

namespace planum {
namespace {

using testing::PlanMaker;
using testing::Vector3d;

constexpr double left = 2, right = 3.4, sill = 0.9, top = 2.1, depth = 0.3, wall_y = 5;

/// A room whose wall at y = 5 has a window; some reveals may be missing.
struct WindowedRoom {
  PlanMaker plan;
  std::size_t wall = 0;

  void add_jambs(double low = sill) {
    const Vector3d up(0, 0, top - low), in(0, depth, 0);
    const Vector3d a(left, wall_y, low), b(right, wall_y, low);
    plan.add("unknown", {a, a + in, a + in + up, a + up});
    plan.add("unknown", {b, b + up, b + in + up, b + in});
  }
  void add_sill_and_lintel() {
    plan.add("unknown", {{left, wall_y, sill},
                         {left, wall_y + depth, sill},
                         {right, wall_y + depth, sill},
                         {right, wall_y, sill}});
    std::reverse(plan.map.polygons.back().outer.begin(), plan.map.polygons.back().outer.end());
    plan.map.polygons.back().plane = {Vector3d::UnitZ(), sill};
    plan.add("unknown", {{left, wall_y, top},
                         {left, wall_y + depth, top},
                         {right, wall_y + depth, top},
                         {right, wall_y, top}});
    plan.map.polygons.back().plane = {-Vector3d::UnitZ(), -top};
  }

  RoomMap with_windows(const Pose& world_from_plan = Pose::Identity()) const {
    const PolygonMap map = plan.moved(world_from_plan);
    Labels labels;
    for (std::size_t i = 0; i < map.polygons.size(); ++i)
      labels.polygons.push_back({i == wall ? Label::wall : Label::unknown, 1});
    RoomMap rooms;
    rooms.rooms.emplace_back();
    rooms.rooms.front().outline = {world_from_plan * Vector3d(0, 0, 0)};
    rooms.room_of_polygon.assign(map.polygons.size(), 0);
    return with_blind_windows(map, labels, rooms);
  }
};

WindowedRoom room_with_hole(double low = sill) {
  WindowedRoom room;
  room.plan.add("wall", {{0, wall_y, 0}, {6, wall_y, 0}, {6, wall_y, 3}, {0, wall_y, 3}});
  PolygonMap& map = room.plan.map;
  Ring hole;
  for (const Vector3d& p : {Vector3d(left, wall_y, low), Vector3d(left, wall_y, top),
                            Vector3d(right, wall_y, top), Vector3d(right, wall_y, low)}) {
    hole.push_back(static_cast<std::uint32_t>(map.vertices.size()));
    map.vertices.push_back(p);
  }
  map.polygons[0].holes.push_back(hole);
  return room;
}

void expect_the_window(const RoomMap& rooms, const Pose& world_from_plan = Pose::Identity()) {
  ASSERT_EQ(rooms.openings.size(), 1u);
  const Opening& window = rooms.openings.front();
  EXPECT_EQ(window.kind, OpeningKind::window);
  EXPECT_NEAR(window.width, right - left, 1e-6);
  EXPECT_NEAR(window.height, top - sill, 1e-6);
  EXPECT_NEAR(window.sill, sill, 1e-6);
  EXPECT_NEAR(window.thickness, depth, 1e-6);
  EXPECT_EQ(window.rooms, std::vector<std::size_t>{0});
  const Vector3d middle((left + right) / 2, wall_y + depth / 2, (sill + top) / 2);
  EXPECT_LT((window.position - world_from_plan * middle).norm(), 1e-6);
  EXPECT_LT((window.across - world_from_plan.linear() * Vector3d::UnitY()).norm(), 1e-6);
}

TEST(BlindWindows, AreHolesWithReveals) {
  WindowedRoom jambs = room_with_hole(), others = room_with_hole();
  jambs.add_jambs();
  others.add_sill_and_lintel();
  expect_the_window(jambs.with_windows());
  expect_the_window(others.with_windows());
  others.add_jambs();
  expect_the_window(others.with_windows());
}

TEST(BlindWindows, AreFoundBetweenJambsWhereTheHoleIsOpenToOneSide) {
  WindowedRoom room;
  room.plan.add("wall", {{0, wall_y, 0},
                         {left, wall_y, 0},
                         {left, wall_y, top},
                         {right, wall_y, top},
                         {right, wall_y, 0},
                         {6, wall_y, 0},
                         {6, wall_y, 3},
                         {0, wall_y, 3}});
  room.add_jambs();
  expect_the_window(room.with_windows());
}

TEST(BlindWindows, TurnWithTheRoom) {
  WindowedRoom room = room_with_hole();
  room.add_jambs();
  for (const double angle : {0.4, 2.0, 4.5}) {
    Pose pose(Eigen::Translation3d(3, -8, 1.5));
    pose.rotate(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
    expect_the_window(room.with_windows(pose), pose);
  }
}

TEST(BlindWindows, NeedTwoRevealsASillAndNothingBehind) {
  EXPECT_TRUE(room_with_hole().with_windows().openings.empty());
  WindowedRoom niche = room_with_hole();
  niche.add_jambs();
  niche.plan.add("unknown", {{left, wall_y + depth, sill},
                             {right, wall_y + depth, sill},
                             {right, wall_y + depth, top},
                             {left, wall_y + depth, top}});
  EXPECT_TRUE(niche.with_windows().openings.empty());
  WindowedRoom low = room_with_hole(0.1);
  low.add_jambs(0.1);
  EXPECT_TRUE(low.with_windows().openings.empty());
}

TEST(BlindWindows, AreNotFoundTwice) {
  WindowedRoom room = room_with_hole();
  room.add_jambs();
  Labels labels;
  labels.polygons.assign(room.plan.map.polygons.size(), {Label::unknown, 1});
  labels.polygons[0] = {Label::wall, 1};
  const RoomMap again = with_blind_windows(room.plan.map, labels, room.with_windows());
  EXPECT_EQ(again.openings.size(), 1u);
}

TEST(BlindWindows, NeedALabelAndARoomForEachPolygon) {
  EXPECT_THROW(with_blind_windows(room_with_hole().plan.map, {}, {}), Error);
}

}  // namespace
}  // namespace planum
