#include "labeling/labels.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/labeling/plans.hpp"

namespace planum {
namespace {

using testing::PlanMaker;
using testing::Vector3d;

void expect_labels(const PlanMaker& plan, const Labels& labels) {
  ASSERT_EQ(labels.polygons.size(), plan.labels.size());
  for (std::size_t i = 0; i < plan.labels.size(); ++i) {
    EXPECT_EQ(name(labels.polygons[i].label), plan.labels[i])
        << "polygon " << i << ": normal " << plan.map.polygons[i].plane.normal.transpose()
        << ", area " << plan.map.polygons[i].area << ", first vertex "
        << plan.map.vertices[plan.map.polygons[i].outer[0]].transpose();
    EXPECT_GE(labels.polygons[i].confidence, 0);
    EXPECT_LE(labels.polygons[i].confidence, 1);
  }
}

/// A room with two tables, a cupboard at the wall, a shelf board and a lamp.
PlanMaker furnished_room() {
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {7, 6, 3});
  plan.add_furniture({1, 1, 0}, {1.6, 1.9, 0.74});
  plan.add_furniture({3, 4, 0}, {4.5, 4.8, 0.74});
  plan.add_furniture({5.2, 0.1, 0}, {6.6, 0.55, 1.9});
  plan.add_board({2, 5.6, 1.2}, {3, 5.95, 1.23});
  plan.add_board({3, 2, 2.5}, {3.4, 3.2, 2.6}, "unknown");
  return plan;
}

/// A classroom of 2.99 m and a hall of 2.6 m with a door between them; walls are 15 cm thick.
PlanMaker room_and_hall() {
  PlanMaker plan;
  const auto wall_with_door = [&](double x, double y0, double y1, double height, bool look_back) {
    std::vector<Vector3d> ring{{x, y0, 0},  {x, y0, height}, {x, y1, height}, {x, y1, 0},
                               {x, 2.2, 0}, {x, 2.2, 2},     {x, 1.2, 2},     {x, 1.2, 0}};
    if (!look_back) std::reverse(ring.begin(), ring.end());
    plan.add("wall", ring);
  };
  plan.add("floor", {{0, 0, 0},
                     {7, 0, 0},
                     {7, 1.2, 0},
                     {7.15, 1.2, 0},
                     {7.15, -1.5, 0},
                     {9.15, -1.5, 0},
                     {9.15, 7.5, 0},
                     {7.15, 7.5, 0},
                     {7.15, 2.2, 0},
                     {7, 2.2, 0},
                     {7, 6, 0},
                     {0, 6, 0}});
  plan.add("ceiling", {{0, 0, 2.99}, {0, 6, 2.99}, {7, 6, 2.99}, {7, 0, 2.99}});
  plan.add("ceiling", {{7.15, -1.5, 2.6}, {7.15, 7.5, 2.6}, {9.15, 7.5, 2.6}, {9.15, -1.5, 2.6}});
  plan.add("wall", {{0, 0, 0}, {0, 6, 0}, {0, 6, 2.99}, {0, 0, 2.99}});
  plan.add("wall", {{0, 0, 0}, {0, 0, 2.99}, {7, 0, 2.99}, {7, 0, 0}});
  plan.add("wall", {{0, 6, 0}, {7, 6, 0}, {7, 6, 2.99}, {0, 6, 2.99}});
  wall_with_door(7, 0, 6, 2.99, true);
  wall_with_door(7.15, -1.5, 7.5, 2.6, false);
  plan.add("wall", {{9.15, -1.5, 0}, {9.15, -1.5, 2.6}, {9.15, 7.5, 2.6}, {9.15, 7.5, 0}});
  // Jambs and lintel: ends of walls as long as nobody knows of the door.
  plan.add("wall", {{7, 1.2, 0}, {7, 1.2, 2}, {7.15, 1.2, 2}, {7.15, 1.2, 0}});
  plan.add("wall", {{7, 2.2, 0}, {7.15, 2.2, 0}, {7.15, 2.2, 2}, {7, 2.2, 2}});
  plan.add("wall", {{7, 1.2, 2}, {7, 2.2, 2}, {7.15, 2.2, 2}, {7.15, 1.2, 2}});
  return plan;
}

TEST(Labels, TellARoomFromItsFurniture) {
  const PlanMaker plan = furnished_room();
  expect_labels(plan, label(plan.map));
}

TEST(Labels, TakeCeilingsOfSeveralHeights) {
  const PlanMaker plan = room_and_hall();
  expect_labels(plan, label(plan.map));
}

TEST(Labels, AreThoseOfTheSceneTurnedAndMoved) {
  for (const PlanMaker& plan : {furnished_room(), room_and_hall()}) {
    const Labels before = label(plan.map);
    for (int k = 0; k < 12; ++k) {
      const Vector3d axis(std::cos(k), std::sin(k), 0.4 * std::sin(3 * k));
      Pose pose = Pose::Identity();
      pose.rotate(Eigen::AngleAxisd(radians(20), axis.normalized()));
      pose.pretranslate(Vector3d(-30, 40, 5));
      const Labels after = label(plan.moved(pose));
      expect_labels(plan, after);
      EXPECT_GT(after.up.dot(pose.linear() * before.up), std::cos(radians(0.1)));
      for (std::size_t i = 0; i < after.polygons.size(); ++i)
        EXPECT_NEAR(after.polygons[i].confidence, before.polygons[i].confidence, 0.05);
    }
  }
}

TEST(Labels, AreTheSameHoweverTheSceneIsTurnedAboutUp) {
  const PlanMaker plan = furnished_room();
  for (const double angle : {1.0, 2.5, 4.0}) {
    Pose pose = Pose::Identity();
    pose.rotate(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
    expect_labels(plan, label(plan.moved(pose)));
  }
}

TEST(Labels, TakeSeveralStoreys) {
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {8, 5, 2.7});
  plan.add_room({0, 0, 3}, {8, 5, 5.7});
  plan.add_furniture({1, 1, 3}, {2, 2, 3.7});
  expect_labels(plan, label(plan.map));
}

TEST(Labels, TakeAFloorOnTwoLevels) {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}});
  plan.add("floor", {{5, 0, 0.4}, {10, 0, 0.4}, {10, 5, 0.4}, {5, 5, 0.4}});
  plan.add("stair", {{5, 0, 0}, {5, 0, 0.4}, {5, 5, 0.4}, {5, 5, 0}});
  plan.add("ceiling", {{0, 0, 3}, {0, 5, 3}, {10, 5, 3}, {10, 0, 3}});
  plan.add("wall", {{0, 0, 0}, {0, 5, 0}, {0, 5, 3}, {0, 0, 3}});
  plan.add("wall", {{10, 0, 0.4}, {10, 0, 3}, {10, 5, 3}, {10, 5, 0.4}});
  expect_labels(plan, label(plan.map));
}

TEST(Labels, NeedNoCeiling) {
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {7, 6, 2.6}, false);
  plan.add_furniture({1, 1, 0}, {1.6, 1.9, 0.74});
  plan.add_furniture({5.2, 0.1, 0}, {6.6, 0.55, 1.9});
  expect_labels(plan, label(plan.map));
}

/// A flight of stairs against the wall x = 0, from the floor up to a landing.
PlanMaker stairwell(int steps, double rise, double going) {
  PlanMaker plan;
  const double length = steps * going, top = (steps + 1) * rise;
  plan.add("floor", {{0, -4, 0}, {5, -4, 0}, {5, 0, 0}, {0, 0, 0}});
  for (int k = 0; k <= steps; ++k) {
    const double y = k * going, z = k * rise;
    plan.add("stair", {{0, y, z}, {1.2, y, z}, {1.2, y, z + rise}, {0, y, z + rise}});
    if (k < steps)
      plan.add("stair", {{0, y, z + rise},
                         {1.2, y, z + rise},
                         {1.2, y + going, z + rise},
                         {0, y + going, z + rise}});
  }
  plan.add("floor",
           {{0, length, top}, {5, length, top}, {5, length + 3, top}, {0, length + 3, top}});
  plan.add("wall", {{0, -4, 0}, {0, length + 3, 0}, {0, length + 3, 6}, {0, -4, 6}});
  plan.add("wall", {{5, -4, 0}, {5, -4, 6}, {5, length + 3, 6}, {5, length + 3, 0}});
  plan.add("ceiling", {{0, -4, 6}, {0, length + 3, 6}, {5, length + 3, 6}, {5, -4, 6}});
  return plan;
}

TEST(Labels, KnowStairs) {
  for (const int steps : {2, 6, 12})
    for (const double rise : {0.15, 0.18, 0.21}) {
      SCOPED_TRACE(std::to_string(steps) + " steps of " + std::to_string(rise) + " m");
      const PlanMaker plan = stairwell(steps, rise, 0.63 - 2 * rise);
      expect_labels(plan, label(plan.map));
    }
}

TEST(Labels, TakeAFlightWithoutStepsForStairs) {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
  plan.add("stair", {{0, 3, 0}, {4, 3, 0}, {4, 6, 1.7}, {0, 6, 1.7}});
  plan.add("wall", {{0, 0, 0}, {0, 6, 0}, {0, 6, 4}, {0, 0, 4}});
  plan.add("unknown", {{5, 3, 2}, {9, 3, 2}, {9, 6, 4}, {5, 6, 4}});  // no floor at its foot
  expect_labels(plan, label(plan.map));
}

TEST(Labels, TakeNoShelvesForStairs) {
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {7, 6, 3});
  for (const double z : {0.2, 0.4, 0.6, 0.8}) plan.add_board({2, 5.6, z}, {3, 5.95, z + 0.02});
  expect_labels(plan, label(plan.map));
}

/// A room whose wall at y = 5 has a niche 15 cm deep between `low` and `high`, closed at its back.
PlanMaker room_with_niche(const std::string& expected, const Vector3d& low, const Vector3d& high) {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {6, 0, 0}, {6, 5, 0}, {0, 5, 0}});
  plan.add("ceiling", {{0, 0, 3}, {0, 5, 3}, {6, 5, 3}, {6, 0, 3}});
  plan.add("wall", {{0, 0, 0}, {0, 5, 0}, {0, 5, 3}, {0, 0, 3}});
  plan.add("wall", {{6, 0, 0}, {6, 0, 3}, {6, 5, 3}, {6, 5, 0}});
  plan.add("wall", {{0, 0, 0}, {0, 0, 3}, {6, 0, 3}, {6, 0, 0}});
  std::vector<Vector3d> around{{0, 5, 0},
                               {low.x(), 5, 0},
                               {low.x(), 5, high.z()},
                               {high.x(), 5, high.z()},
                               {high.x(), 5, 0},
                               {6, 5, 0},
                               {6, 5, 3},
                               {0, 5, 3}};
  if (low.z() > 0) {
    plan.add("wall",
             {{low.x(), 5, 0}, {high.x(), 5, 0}, {high.x(), 5, low.z()}, {low.x(), 5, low.z()}});
  }
  plan.add("wall", around);
  plan.add(expected, {{low.x(), 5.15, low.z()},
                      {high.x(), 5.15, low.z()},
                      {high.x(), 5.15, high.z()},
                      {low.x(), 5.15, high.z()}});
  return plan;
}

TEST(Labels, KnowClosedDoorsAndBlindWindowsSetBackIntoTheWall) {
  for (const PlanMaker& plan : {room_with_niche("door", {2, 5, 0}, {2.9, 5, 2.05}),
                                room_with_niche("window", {2, 5, 0.9}, {3.5, 5, 2.1})})
    expect_labels(plan, label(plan.map));
}

TEST(Labels, TakeLowWallsWhereTheFloorEnds) {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {6, 0, 0}, {6, 5, 0}, {0, 5, 0}});
  plan.add("wall", {{0, 5, 0}, {6, 5, 0}, {6, 5, 0.8}, {0, 5, 0.8}});
  plan.add("wall", {{0, 0, 0}, {0, 5, 0}, {0, 5, 2.5}, {0, 0, 2.5}});
  plan.add("furniture_vertical", {{1, 2, 0}, {4, 2, 0}, {4, 2, 0.8}, {1, 2, 0.8}});
  expect_labels(plan, label(plan.map));
}

TEST(Labels, TakeAnAtticsSlantsForItsCeiling) {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {8, 0, 0}, {8, 6, 0}, {0, 6, 0}});
  plan.add("ceiling", {{0, 0, 1}, {0, 3, 4}, {8, 3, 4}, {8, 0, 1}});
  plan.add("ceiling", {{0, 3, 4}, {0, 6, 1}, {8, 6, 1}, {8, 3, 4}});
  plan.add("wall", {{0, 0, 0}, {0, 6, 0}, {0, 6, 1}, {0, 3, 4}, {0, 0, 1}});
  expect_labels(plan, label(plan.map));
}

TEST(Labels, OfAMapWithoutAFloorOrOfOneWallAreNoLie) {
  PlanMaker wall;
  wall.add("wall", {{0, 0, 0}, {0, 5, 0}, {0, 5, 3}, {0, 0, 3}});
  EXPECT_LE(label(wall.map).polygons[0].confidence, 0.8);
  PlanMaker boards;
  for (const double x : {0.0, 2.0, 4.0}) {
    const double low = 2 * x, high = low + 2;
    boards.add("unknown", {{x, 0, low}, {x + 1, 0, high}, {x + 1, 2, high}, {x, 2, low}});
  }
  expect_labels(boards, label(boards.map));
}

Opening door_at(const Vector3d& middle, const Vector3d& across, double thickness) {
  Opening door;
  door.position = middle;
  door.across = across;
  door.width = 1;
  door.height = 2;
  door.thickness = thickness;
  return door;
}

TEST(Labels, TakeFramesAndLeavesOfOpenDoorsForDoors) {
  PlanMaker plan = room_and_hall();
  const auto is_frame = [&](std::size_t i) { return i + 3 >= plan.labels.size(); };
  for (std::size_t i = 0; i < plan.labels.size(); ++i)
    if (is_frame(i)) plan.labels[i] = "door";
  plan.add("door", {{7, 1.2, 0.02}, {6.05, 1.2, 0.02}, {6.05, 1.2, 1.98}, {7, 1.2, 1.98}});
  plan.add("wall", {{5, 4.5, 0}, {4.05, 4.5, 0}, {4.05, 4.5, 2}, {5, 4.5, 2}});  // not at a jamb
  const Opening doors[] = {door_at({7.075, 1.7, 1}, {1, 0, 0}, 0.15)};
  expect_labels(plan, with_openings(plan.map, label(plan.map), doors));
}

TEST(Labels, OfOpeningsNeedOneForEachPolygon) {
  const PlanMaker plan = room_and_hall();
  EXPECT_THROW(with_openings(plan.map, {}, {}), Error);
}

TEST(Labels, LeaveRampsAndRoofsAlone) {
  PlanMaker plan = furnished_room();
  plan.add("unknown", {{1, 3, 0}, {1.5, 3, 1}, {1.5, 4, 1}, {1, 4, 0}});
  expect_labels(plan, label(plan.map));
}

TEST(Labels, AreTheSameForAnyNumberOfThreads) {
  const PlanMaker plan = furnished_room();
  set_thread_count(1);
  const Labels one = label(plan.map);
  set_thread_count(4);
  const Labels four = label(plan.map);
  set_thread_count(0);
  for (std::size_t i = 0; i < one.polygons.size(); ++i) {
    EXPECT_EQ(one.polygons[i].label, four.polygons[i].label);
    EXPECT_EQ(one.polygons[i].confidence, four.polygons[i].confidence);
  }
}

TEST(Labels, OfAnEmptyMapAreEmpty) { EXPECT_TRUE(label({}).polygons.empty()); }

TEST(Labels, SayWhichParameterIsWrong) {
  try {
    label({}, {.max_tilt = 1});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "labels: max_tilt is 1.000000 rad, must be above 0 and below 0.785");
  }
  EXPECT_THROW(label({}, {.min_headroom = -1}), Error);
}

}  // namespace
}  // namespace planum
