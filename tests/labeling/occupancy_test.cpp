#include "labeling/occupancy.hpp"

#include <gtest/gtest.h>

#include "meshing/normals.hpp"
#include "meshing/surface.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scanned_scene.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::add_box;
using testing::looking;

/// A scanned room and its surface.
struct Room {
  testing::ScannedScene scene;
  TriangleMesh mesh;

  OccupancyGrid map(const OccupancyParams& params = {}) const {
    return occupancy_grid(scene.cloud, scene.origins, mesh, 0, params);
  }
};

/// A room of 5 x 4 x 2.5 m with a cupboard (2 m high), a shelf at 1.8 m, and a sill of 5 cm.
Room room() {
  TriangleMesh model;
  add_box(model, {0, 0, 0}, {5, 4, 2.5});
  add_box(model, {3.0, 1.2, 0}, {3.6, 2.0, 2.0});
  add_box(model, {1.0, 3.6, 1.8}, {2.0, 4.0, 1.9});
  add_box(model, {1.0, 0.0, 0}, {2.0, 0.3, 0.05});
  testing::ScannedScene scene = testing::scanned(
      model,
      {looking({0.6, 1.9, 0.7}, 0), looking({4.4, 3.3, 0.7}, -140), looking({4.5, 0.5, 0.7}, 140)});
  scene.cloud.normals = estimate_normals(scene.cloud, scene.origins);
  TriangleMesh mesh = reconstruct(scene.cloud);
  return {std::move(scene), std::move(mesh)};
}

Occupancy at(const OccupancyGrid& map, const Vector2d& place) {
  const std::ptrdiff_t cell = map.grid.find(place - map.corner());
  EXPECT_GE(cell, 0);
  return map.cells[static_cast<std::size_t>(cell)];
}

/// Whether there is something at a place or in the cells around it: surfaces lie between cells.
bool is_blocked(const OccupancyGrid& map, const Vector2d& place) {
  for (const double x : {-0.05, 0.0, 0.05})
    for (const double y : {-0.05, 0.0, 0.05})
      if (at(map, place + Vector2d(x, y)) == Occupancy::occupied) return true;
  return false;
}

TEST(OccupancyGrid, HasWhatIsInTheWayOfARobot) {
  const Room scanned = room();
  const OccupancyGrid map = scanned.map({.high = 1.5});
  EXPECT_EQ(map.cells.size(), map.grid.size());
  for (double x = 0.3; x < 4.8; x += 0.1) {
    EXPECT_TRUE(is_blocked(map, {x, 0.0})) << x;  // walls
    EXPECT_EQ(at(map, {x, 0.5}), Occupancy::free) << x;
  }
  for (double y = 1.3; y < 1.95; y += 0.1) EXPECT_TRUE(is_blocked(map, {3.0, y}));
  EXPECT_EQ(at(map, {3.3, 1.6}), Occupancy::unknown);  // inside the cupboard
  EXPECT_EQ(at(map, {1.5, 0.15}), Occupancy::free);    // the sill
  EXPECT_EQ(at(map, {1.5, 3.75}), Occupancy::free);    // under the shelf
  const OccupancyGrid tall = scanned.map({.high = 2.2});
  EXPECT_TRUE(is_blocked(tall, {1.5, 3.6}));
  EXPECT_FALSE(is_blocked(map, {1.5, 3.6}));
  const OccupancyGrid low = scanned.map({.low = 0.02});
  EXPECT_TRUE(is_blocked(low, {1.5, 0.3}));
  EXPECT_FALSE(is_blocked(map, {1.5, 0.3}));
}

TEST(OccupancyGrid, HasItsCellsAtMultiplesOfTheirSize) {
  const Room scanned = room();
  const OccupancyGrid map = scanned.map({.cell = 0.1});
  for (const double c : {map.corner().x(), map.corner().y()})
    EXPECT_NEAR(c / 0.1, std::round(c / 0.1), 1e-9);
  EXPECT_TRUE(map.grid.plan_from_world.linear().isIdentity());
}

TEST(OccupancyGrid, MovesWithTheWorld) {
  Room scanned = room();
  const OccupancyGrid before = scanned.map();
  const Vector3d shift(-64, 32, 4);  // exact in float for these points but for the last bits
  for (auto* points : {&scanned.scene.cloud.points, &scanned.mesh.vertices})
    for (Eigen::Vector3f& p : *points) p += shift.cast<float>();
  for (Vector3d& o : scanned.scene.origins) o += shift;
  const OccupancyGrid after =
      occupancy_grid(scanned.scene.cloud, scanned.scene.origins, scanned.mesh, 4);
  ASSERT_EQ(after.cells.size(), before.cells.size());
  std::size_t differences = 0;
  for (std::size_t i = 0; i < after.cells.size(); ++i)
    differences += after.cells[i] != before.cells[i];
  EXPECT_LT(differences, after.cells.size() / 100);
  EXPECT_LT((after.corner() - before.corner() - shift.head<2>()).norm(), 1e-9);
}

TEST(OccupancyGrid, IsTheSameForAnyNumberOfThreads) {
  const Room scanned = room();
  set_thread_count(1);
  const OccupancyGrid one = scanned.map();
  set_thread_count(4);
  const OccupancyGrid four = scanned.map();
  set_thread_count(0);
  EXPECT_EQ(one.cells, four.cells);
}

TEST(OccupancyGrid, SaysWhatIsWrong) {
  Cloud cloud;
  cloud.points = {{0, 0, 0}};
  const std::vector<Vector3d> origins(2, Vector3d::UnitZ());
  EXPECT_THROW(occupancy_grid(cloud, origins, {}, 0), Error);  // no normals
  cloud.normals = {Eigen::Vector3f::UnitZ()};
  EXPECT_THROW(occupancy_grid(cloud, origins, {}, 0), Error);  // of which scan?
  cloud.scan = {2};
  EXPECT_THROW(occupancy_grid(cloud, origins, {}, 0), Error);
  cloud.scan = {1};
  EXPECT_EQ(occupancy_grid(cloud, origins, {}, 0).cells.size(), 9u);
  EXPECT_THROW(occupancy_grid(cloud, origins, {}, 0, {.cell = 0}), Error);
  EXPECT_THROW(occupancy_grid(cloud, origins, {}, 0, {.low = 2}), Error);
  EXPECT_TRUE(occupancy_grid({}, origins, {}, 0).cells.empty());
}

TEST(StoreyFloors, AreThoseFarApartWithEnoughFloor) {
  PolygonMap map;
  Labels labels;
  const auto add = [&](double height, double side, Label label) {
    const auto first = static_cast<std::uint32_t>(map.vertices.size());
    for (const Vector2d& p : {Vector2d(0, 0), {side, 0}, {side, side}, {0, side}})
      map.vertices.emplace_back(p.x(), p.y(), height);
    map.polygons.push_back(
        {{Vector3d::UnitZ(), height}, {first, first + 1, first + 2, first + 3}, {}, side * side});
    labels.polygons.push_back({label, 1});
  };
  add(3.1, 2, Label::floor);
  add(0.0, 3, Label::floor);
  add(0.4, 2, Label::floor);  // a platform
  add(6.0, 1, Label::floor);  // too small
  add(2.4, 5, Label::ceiling);
  EXPECT_EQ(storey_floors(map, labels), (std::vector<double>{0.0, 3.1}));
  EXPECT_TRUE(storey_floors({}, {}).empty());
  EXPECT_THROW(storey_floors(map, {}), Error);
}

}  // namespace
}  // namespace planum
