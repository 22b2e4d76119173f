#include "labeling/rooms/rooms.hpp"

#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/slices.hpp"
#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/furniture.hpp"
#include "slam/sensor/random_building.hpp"
#include "tests/labeling/plans.hpp"
#include "tests/labeling/scanned_building.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::ModelMaker;
using testing::rooms_in;
using testing::scanned;
using testing::ScannedWorld;

Pose upright_pose(double x, double y, double heading) {
  return pose_from_xyz_ypr({x, y, 0.6}, radians(heading), 0, 0);
}

/// An office and a corridor, turned, with a desk, a cabinet as high as the ceiling, and a door.
const Building& small_building() {
  static const Building building = [] {
    BuildingPlan plan{
        .name = "small",
        .rooms = {{"office", {{{0, 0}, {4.2, 0}, {4.2, 3.4}, {0, 3.4}}, {}}, 2.7},
                  {"corridor", {{{0, 3.6}, {4.2, 3.6}, {4.2, 5.2}, {0, 5.2}}, {}}, 2.45}},
        .doors = {{{"office", "corridor"}, {2.6, 3.5}, 0.95, 2.02}}};
    for (const auto& boxes : {table({1, 0.6}, {1.4, 0.7}), cabinet({3.9, 1.5}, {0.6, 1.0}, 2.699)})
      plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
    return built(plan);
  }();
  return building;
}

const ScannedWorld& small_world() {
  static const ScannedWorld world =
      scanned(small_building().mesh.mesh,
              {upright_pose(2.6, 4.4, -90), upright_pose(0.6, 4.4, 0), upright_pose(3.7, 4.4, 180),
               upright_pose(2.2, 2.6, -90), upright_pose(2.6, 0.8, 90), upright_pose(0.6, 1.8, 0)});
  return world;
}

void expect_measures(const RoomMap& rooms, const std::vector<TrueRoom>& truth, double max_length,
                     double max_area) {
  EXPECT_EQ(rooms.rooms.size(), truth.size());
  for (const TrueRoom& room : truth) {
    const Room* found = testing::room_at(rooms, room.centre);
    ASSERT_TRUE(found) << room.name;
    EXPECT_NEAR(found->width, room.width, max_length) << room.name;
    EXPECT_NEAR(found->depth, room.depth, max_length) << room.name;
    EXPECT_NEAR(found->height, room.height, max_length) << room.name;
    EXPECT_NEAR(found->area, room.area, max_area * room.area) << room.name;
    EXPECT_LT((found->centre.head<2>() - room.centre).norm(), 2 * max_length) << room.name;
  }
}

TEST(Rooms, MeasuresTheDemonstrationBuilding) {
  const Building building = demo_building();
  expect_measures(rooms_in(scanned(building.mesh.mesh, demo_poses())), building.rooms, 0.02, 0.02);
}

TEST(Rooms, CountsTheRoomsOfUnseenBuildings) {
  for (const std::uint64_t seed : {2, 6, 8}) {
    SCOPED_TRACE(seed);
    const RandomBuilding random = random_building(seed, 3);
    const RoomMap rooms = rooms_in(scanned(random.building.mesh.mesh, random.poses));
    EXPECT_EQ(rooms.rooms.size(), random.building.rooms.size());
    for (const TrueRoom& room : random.building.rooms)
      EXPECT_TRUE(testing::room_at(rooms, room.centre)) << room.name;
  }
}

TEST(Rooms, HighCabinetsAndDesksDoNotMatter) {
  const RoomMap rooms = rooms_in(small_world());
  ASSERT_EQ(rooms.rooms.size(), 2u);
  const Room* office = testing::room_at(rooms, {2.1, 1.7});
  ASSERT_TRUE(office);
  EXPECT_NEAR(office->width, 3.4, 0.02);
  EXPECT_NEAR(office->depth, 4.2, 0.02);
}

TEST(Rooms, TurningTheWorldTurnsTheRooms) {
  const RoomMap before = rooms_in(small_world());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0, 2 * pi), shift(-20, 20);
  for (int draw = 0; draw < 4; ++draw) {
    const Pose turn =
        pose_from_xyz_ypr({shift(random), shift(random), shift(random)}, angle(random), 0, 0);
    const RoomMap after = rooms_in(testing::moved(small_world(), turn));
    ASSERT_EQ(after.rooms.size(), before.rooms.size());
    ASSERT_EQ(after.openings.size(), before.openings.size());
    for (std::size_t i = 0; i < before.rooms.size(); ++i) {
      EXPECT_LT((after.rooms[i].centre - turn * before.rooms[i].centre).norm(), 0.02);
      EXPECT_NEAR(after.rooms[i].width, before.rooms[i].width, 0.01);
      EXPECT_NEAR(after.rooms[i].depth, before.rooms[i].depth, 0.01);
      EXPECT_NEAR(after.rooms[i].area, before.rooms[i].area, 0.02 * before.rooms[i].area);
      EXPECT_EQ(after.rooms[i].scans, before.rooms[i].scans);
    }
    for (std::size_t i = 0; i < before.openings.size(); ++i) {
      EXPECT_LT((after.openings[i].position - turn * before.openings[i].position).norm(), 0.03);
      EXPECT_NEAR(after.openings[i].width, before.openings[i].width, 0.02);
    }
  }
}

TEST(Rooms, OneThreadGivesTheSameAsMany) {
  const int threads = thread_count();
  set_thread_count(1);
  const RoomMap one = rooms_in(small_world());
  set_thread_count(5);
  const RoomMap many = rooms_in(small_world());
  set_thread_count(threads);
  ASSERT_EQ(one.rooms.size(), many.rooms.size());
  for (std::size_t i = 0; i < one.rooms.size(); ++i) {
    EXPECT_EQ(one.rooms[i].centre, many.rooms[i].centre);
    EXPECT_EQ(one.rooms[i].area, many.rooms[i].area);
    EXPECT_EQ(one.rooms[i].width, many.rooms[i].width);
    EXPECT_EQ(one.rooms[i].outline, many.rooms[i].outline);
  }
  ASSERT_EQ(one.openings.size(), many.openings.size());
  for (std::size_t i = 0; i < one.openings.size(); ++i) {
    EXPECT_EQ(one.openings[i].position, many.openings[i].position);
    EXPECT_EQ(one.openings[i].width, many.openings[i].width);
    EXPECT_EQ(one.openings[i].height, many.openings[i].height);
  }
}

TEST(Rooms, AreNamedInTheOrderOfTheVisit) {
  const RoomMap rooms = rooms_in(small_world());
  ASSERT_EQ(rooms.rooms.size(), 2u);
  EXPECT_EQ(rooms.rooms[0].name, "room 1");
  EXPECT_EQ(rooms.rooms[0].scans, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_NEAR(rooms.rooms[0].centre.y(), 4.4, 0.1);
  EXPECT_EQ(rooms.rooms[1].name, "room 2");
}

TEST(Rooms, ABeamPartsNoRoom) {
  ModelMaker model;
  model.tunnel({0, 0, 0}, {7, 4, 2.8});
  model.wall_across_x(0, {0, 4}, {0, 2.8});
  model.wall_across_x(7, {0, 4}, {0, 2.8});
  model.wall_across_x(3.4, {0, 4}, {2.5, 2.8});
  model.wall_across_x(3.7, {0, 4}, {2.5, 2.8});
  model.rectangle({3.4, 0, 2.5}, {0.3, 0, 0}, {0, 4, 0});
  const RoomMap rooms =
      rooms_in(scanned(model.mesh, {upright_pose(0.7, 2, 0), upright_pose(6.3, 2, 180),
                                    upright_pose(2, 0.8, 90), upright_pose(5, 3.2, -90)}));
  ASSERT_EQ(rooms.rooms.size(), 1u);
  EXPECT_NEAR(rooms.rooms[0].area, 28, 0.5);
  EXPECT_TRUE(rooms.openings.empty());
}

/// A room of 5 m x 4 m with a window of 1.4 m x 1.2 m, sill 0.9 m, and something with a floor and a
/// ceiling behind it: an arcade, or a reflection.
ScannedWorld room_with_window() {
  ModelMaker model;
  model.tunnel({0, 0, 0}, {5, 4, 2.7});
  model.wall_across_x(0, {0, 4}, {0, 2.7});
  model.wall_across_x(5, {0, 4}, {0, 2.7}, {1.2, 2.6}, {0.9, 2.1});
  model.tunnel({5.3, 0, 0}, {9, 4, 2.7});
  model.wall_across_x(5.3, {0, 4}, {0, 2.7}, {1.2, 2.6}, {0.9, 2.1});
  model.wall_across_x(9, {0, 4}, {0, 2.7});
  for (const double y : {1.2, 2.6}) model.rectangle({5, y, 0.9}, {0.3, 0, 0}, {0, 0, 1.2});
  for (const double z : {0.9, 2.1}) model.rectangle({5, 1.2, z}, {0.3, 0, 0}, {0, 1.4, 0});
  return scanned(model.mesh,
                 {upright_pose(1, 2, 0), upright_pose(3.2, 2.6, 20), upright_pose(2.5, 1.2, 90),
                  upright_pose(4, 2, 180), upright_pose(2.5, 3, -60)});
}

TEST(Rooms, WhatIsSeenThroughAWindowIsNoRoom) {
  const RoomMap rooms = rooms_in(room_with_window());
  ASSERT_EQ(rooms.rooms.size(), 1u);
  EXPECT_NEAR(rooms.rooms[0].area, 20, 0.4);
  ASSERT_EQ(rooms.openings.size(), 1u);
  const Opening& window = rooms.openings[0];
  EXPECT_EQ(window.kind, OpeningKind::window);
  EXPECT_EQ(window.rooms, std::vector<std::size_t>{0});
  EXPECT_NEAR(window.width, 1.4, 0.03);
  EXPECT_NEAR(window.height, 1.2, 0.03);
  EXPECT_NEAR(window.sill, 0.9, 0.03);
}

TEST(Rooms, AClassroomSeenWithAHall) {
  PLANUM_SHARED_DATASET(path, "classroom");
  const std::vector<Pose> poses = read_pose_list(path / "true_poses.txt");
  std::vector<Scan> scans;
  ScannedWorld world;
  for (const Pose& pose : poses) {
    RawScan raw = read_slices(path / fmt::format("scan{:03}.slices", scans.size()));
    std::vector<Slice> every_third;
    for (std::size_t s = 0; s < raw.slices.size(); s += 3) every_third.push_back(raw.slices[s]);
    raw.slices = every_third;
    Scan scan;
    scan.world_from_scan = pose;
    scan.cloud = points_from_slices(raw).cloud;
    scans.push_back(std::move(scan));
    world.origins.push_back(pose.translation());
  }
  world.cloud = merged(scans);
  world.cloud.normals = estimate_normals(world.cloud, world.origins);
  const RoomMap rooms = rooms_in(world);
  ASSERT_EQ(rooms.rooms.size(), 2u);
  EXPECT_NEAR(rooms.rooms[0].width, 5.89, 0.01);
  EXPECT_NEAR(rooms.rooms[0].depth, 7.09, 0.01);
  EXPECT_NEAR(rooms.rooms[0].height, 2.99, 0.01);
  EXPECT_NEAR(rooms.rooms[0].area, 5.89 * 7.09, 0.4);
  EXPECT_NEAR(rooms.rooms[1].width, 2.0, 0.02);
  EXPECT_NEAR(rooms.rooms[1].depth, 9.0, 0.02);
  ASSERT_EQ(rooms.openings.size(), 1u);
  EXPECT_EQ(rooms.openings[0].kind, OpeningKind::door);
  EXPECT_NEAR(rooms.openings[0].width, 0.94, 0.02);
  EXPECT_NEAR(rooms.openings[0].height, 2.03, 0.02);
  EXPECT_LT((rooms.openings[0].position - Eigen::Vector3d(7.165, 1.7, 1.015)).norm(), 0.02);
}

TEST(Rooms, PolygonsBelongToTheRoomTheyLookInto) {
  testing::PlanMaker plan;
  plan.add_room({0, 0, 0}, {4.2, 3.4, 2.7});
  plan.add_room({0, 3.6, 0}, {4.2, 5.2, 2.45});
  plan.add_room({20, 0, 0}, {24, 3, 2.7});
  const RoomMap rooms = rooms_in(small_world(), plan.map);
  ASSERT_EQ(rooms.room_of_polygon.size(), 18u);
  for (std::size_t i = 0; i < 18; ++i)
    EXPECT_EQ(rooms.room_of_polygon[i], i < 6 ? 1 : i < 12 ? 0 : -1) << "polygon " << i;
}

/// The points of the small world that `keep(point, normal)`.
template <typename Keep>
ScannedWorld only(const Keep& keep) {
  ScannedWorld result{{}, small_world().origins};
  const Cloud& cloud = small_world().cloud;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!keep(cloud.points[i], cloud.normals[i])) continue;
    result.cloud.points.push_back(cloud.points[i]);
    result.cloud.normals.push_back(cloud.normals[i]);
    result.cloud.scan.push_back(cloud.scan[i]);
  }
  return result;
}

void expect_nothing(const ScannedWorld& world) {
  testing::PlanMaker plan;
  plan.add_room({0, 0, 0}, {1, 1, 1});
  const RoomMap rooms = rooms_in(world, plan.map);
  EXPECT_TRUE(rooms.rooms.empty());
  EXPECT_TRUE(rooms.openings.empty());
  EXPECT_EQ(rooms.room_of_polygon, std::vector<std::int32_t>(6, -1));
}

TEST(Rooms, NothingComesFromNothing) {
  expect_nothing({});
  using Vector = const Eigen::Vector3f&;
  {
    SCOPED_TRACE("a single point");
    bool first = true;
    expect_nothing(only([&](Vector, Vector) { return std::exchange(first, false); }));
  }
  {
    SCOPED_TRACE("no floor");
    expect_nothing(only([](Vector, Vector n) { return n.z() < 0.5f; }));
  }
  {
    SCOPED_TRACE("one wall only");
    expect_nothing(only([](Vector, Vector n) { return n.x() > 0.9f; }));
  }
  {
    SCOPED_TRACE("no normals known");
    ScannedWorld world = small_world();
    for (Eigen::Vector3f& n : world.cloud.normals) n.setZero();
    expect_nothing(world);
  }
}

TEST(Rooms, AnOpenTopStillHasRooms) {
  const RoomMap rooms = rooms_in(
      only([](const Eigen::Vector3f&, const Eigen::Vector3f& n) { return n.z() > -0.5f; }));
  EXPECT_EQ(rooms.rooms.size(), 2u);
}

std::string message_of(const ScannedWorld& world, const RoomParams& params = {}) {
  try {
    find_rooms(world.cloud, world.origins, {}, params);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Rooms, BadInputIsNamed) {
  ScannedWorld world = small_world();
  world.cloud.normals.pop_back();
  EXPECT_EQ(message_of(world), "rooms: the cloud needs a normal and a scan index for each point");
  world = small_world();
  world.origins.resize(2);
  EXPECT_EQ(message_of(world), "rooms: a point is from scan 2, but there are 2 scans");
  EXPECT_EQ(message_of(small_world(), {.cell = 0.5}), "rooms: cell is 0.5 m, must be 0.01 to 0.2");
}

}  // namespace
}  // namespace planum
