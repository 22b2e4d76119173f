#include "tools/maps/navmesh.hpp"

#include <DetourAlloc.h>
#include <DetourNavMesh.h>
#include <DetourNavMeshQuery.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using testing::error_of;
using testing::PlanMaker;
using testing::SmallMap;
using testing::TemporaryDirectory;
using testing::text_of;

/// navmesh.bin by docs/formats-results.md and Detour alone; points are those of the world.
class LoadedNavmesh {
 public:
  explicit LoadedNavmesh(const std::filesystem::path& path) : file_(text_of(path)) {
    EXPECT_EQ(file_.substr(0, 4), "TESM");
    EXPECT_EQ(next<std::int32_t>(4), 1);
    const auto tiles = next<std::int32_t>(8);
    const auto params = next<dtNavMeshParams>(12);
    EXPECT_TRUE(dtStatusSucceed(mesh_->init(&params)));
    std::size_t at = 40;
    for (int i = 0; i < tiles; ++i) {
      const auto reference = next<dtTileRef>(at);
      const auto size = static_cast<std::size_t>(next<std::int32_t>(at + 4));
      auto* data = static_cast<unsigned char*>(dtAlloc(size, DT_ALLOC_PERM));
      std::memcpy(data, file_.data() + at + 8, size);
      EXPECT_TRUE(dtStatusSucceed(
          mesh_->addTile(data, static_cast<int>(size), DT_TILE_FREE_DATA, reference, nullptr)));
      at += 8 + size;
    }
    EXPECT_EQ(at, file_.size());
    EXPECT_TRUE(dtStatusSucceed(query_->init(mesh_.get(), 2048)));
  }

  /// Whether a robot can stand within a cell of a place.
  bool can_stand(const Vector3d& place) const {
    const Place found = nearest(place, 0.1F);
    const Eigen::Vector3f wanted(float(place.x()), float(place.z()), float(-place.y()));
    return found.reference != 0 && (found.point - wanted).norm() < 0.07F;
  }

  /// m, of the shortest way; not a number if there is none.
  double length_of_way(const Vector3d& from, const Vector3d& to) const {
    const Place a = nearest(from, 0.3F), b = nearest(to, 0.3F);
    if (a.reference == 0 || b.reference == 0) return std::numeric_limits<double>::quiet_NaN();
    const dtQueryFilter filter;
    dtPolyRef polygons[256];
    int count = 0, corners = 0;
    query_->findPath(a.reference, b.reference, a.point.data(), b.point.data(), &filter, polygons,
                     &count, 256);
    if (count == 0 || polygons[count - 1] != b.reference)
      return std::numeric_limits<double>::quiet_NaN();
    std::vector<Eigen::Vector3f> way(256);
    query_->findStraightPath(a.point.data(), b.point.data(), polygons, count, way[0].data(),
                             nullptr, nullptr, &corners, 256);
    double length = 0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(corners); ++i)
      length += static_cast<double>((way[i] - way[i - 1]).norm());
    return length;
  }

 private:
  struct Place {
    dtPolyRef reference = 0;
    Eigen::Vector3f point;
  };

  template <class T>
  T next(std::size_t at) const {
    T value = {};
    EXPECT_LE(at + sizeof(T), file_.size());
    std::memcpy(&value, file_.data() + at, sizeof(T));
    return value;
  }

  Place nearest(const Vector3d& p, float reach) const {
    const float wanted[3] = {float(p.x()), float(p.z()), float(-p.y())};
    const float box[3] = {reach, 0.2F, reach};
    Place place;
    const dtQueryFilter filter;
    EXPECT_TRUE(dtStatusSucceed(
        query_->findNearestPoly(wanted, box, &filter, &place.reference, place.point.data())));
    return place;
  }

  std::string file_;
  std::unique_ptr<dtNavMesh, void (*)(dtNavMesh*)> mesh_{dtAllocNavMesh(), dtFreeNavMesh};
  std::unique_ptr<dtNavMeshQuery, void (*)(dtNavMeshQuery*)> query_{dtAllocNavMeshQuery(),
                                                                    dtFreeNavMeshQuery};
};

/// Rooms from x = 0 to 4 and from 4.2 to 9, both 5 m deep and 2.5 m high; a door of 1 x 2 m at
/// y = 1, whose jambs were seen and whose floor was only if `with_threshold`; a table of 0.75 m in
/// the second room.
SmallMap two_rooms_with_a_door(bool with_door = true, bool with_threshold = false) {
  const double low = 0.5, high = 1.5, top = 2;  // the hole in the wall
  PlanMaker plan;
  const auto wall = [&](double x, bool looks_back) {
    std::vector<Vector3d> outer = {{x, 0, 0}, {x, 5, 0}, {x, 5, 2.5}, {x, 0, 2.5}};
    if (with_door)
      outer = {{x, 0, 0},    {x, low, 0}, {x, low, top}, {x, high, top},
               {x, high, 0}, {x, 5, 0},   {x, 5, 2.5},   {x, 0, 2.5}};
    if (looks_back) std::reverse(outer.begin(), outer.end());
    plan.add("wall", outer);
  };
  plan.add("floor", {{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}});
  plan.add("floor", {{4.2, 0, 0}, {9, 0, 0}, {9, 5, 0}, {4.2, 5, 0}});
  plan.add("ceiling", {{0, 0, 2.5}, {0, 5, 2.5}, {9, 5, 2.5}, {9, 0, 2.5}});
  plan.add("wall", {{0, 0, 0}, {0, 0, 2.5}, {9, 0, 2.5}, {9, 0, 0}});
  plan.add("wall", {{0, 5, 0}, {9, 5, 0}, {9, 5, 2.5}, {0, 5, 2.5}});
  plan.add("wall", {{0, 0, 0}, {0, 5, 0}, {0, 5, 2.5}, {0, 0, 2.5}});
  plan.add("wall", {{9, 0, 0}, {9, 0, 2.5}, {9, 5, 2.5}, {9, 5, 0}});
  wall(4, true);
  wall(4.2, false);
  SmallMap result;
  if (with_door) {
    plan.add("door", {{4, low, 0}, {4.2, low, 0}, {4.2, low, top}, {4, low, top}});
    plan.add("door", {{4, high, 0}, {4, high, top}, {4.2, high, top}, {4.2, high, 0}});
    if (with_threshold)
      plan.add("door", {{4, low, 0}, {4.2, low, 0}, {4.2, high, 0}, {4, high, 0}});
    Opening door;
    door.position = {4.1, 1, 1};
    door.width = 1;
    door.height = 2;
    door.thickness = 0.2;
    if (!with_threshold) result.rooms.openings = {door};
  }
  plan.add_board({6, 3, 0.7}, {8, 4.5, 0.75});
  result.map = plan.map;
  for (const std::string& word : plan.labels)
    for (const Label label : all_labels)
      if (name(label) == word) result.labels.polygons.push_back({label, 1});
  return result;
}

TEST(Navmesh, LeadsThroughADoorOnTheShortestWay) {
  const TemporaryDirectory directory;
  for (const bool with_threshold : {false, true}) {
    const SmallMap rooms = two_rooms_with_a_door(true, with_threshold);
    write_navmesh(directory / "navmesh.bin", triangulated(rooms.map), rooms.labelled());
    const LoadedNavmesh mesh(directory / "navmesh.bin");
    // Straight through the door, and around its jamb at a distance of 0.25 m.
    EXPECT_NEAR(mesh.length_of_way({1, 1, 0}, {8, 1, 0}), 7, 0.02);
    // A rope around the edges of the jamb, (4, 1.5) and (4.2, 1.5), at 0.25 m: its ends are
    // tangents of circles, between them it turns by 138 degrees.
    const double truth = std::sqrt(2 * 2 + 3 * 3 - 0.25 * 0.25) + 0.2 + 0.25 * radians(138) +
                         std::sqrt(0.8 * 0.8 + 2.5 * 2.5 - 0.25 * 0.25);
    EXPECT_NEAR(mesh.length_of_way({2, 4.5, 0}, {5, 4, 0}), truth, 0.02 * truth);
  }
}

TEST(Navmesh, HasNoWayWhereThereIsNoDoor) {
  const TemporaryDirectory directory;
  const SmallMap rooms = two_rooms_with_a_door(false);
  write_navmesh(directory / "navmesh.bin", triangulated(rooms.map), rooms.labelled());
  const LoadedNavmesh mesh(directory / "navmesh.bin");
  EXPECT_TRUE(std::isnan(mesh.length_of_way({1, 1, 0}, {8, 1, 0})));
  EXPECT_NEAR(mesh.length_of_way({1, 1, 0}, {3, 3, 0}), std::sqrt(8), 0.02);
}

TEST(Navmesh, KeepsTheRobotsRadiusFromWallsAndItsHeightUnderTables) {
  const TemporaryDirectory directory;
  const SmallMap rooms = two_rooms_with_a_door();
  const auto path = directory / "navmesh.bin";
  write_navmesh(path, triangulated(rooms.map), rooms.labelled(), {.robot_radius = 0.4});
  const LoadedNavmesh large(path);
  EXPECT_TRUE(large.can_stand({0.55, 2, 0}));
  EXPECT_FALSE(large.can_stand({0.3, 2, 0}));
  EXPECT_FALSE(large.can_stand({7, 3.7, 0}));
  EXPECT_FALSE(large.can_stand({7, 3.7, 0.75}));
  write_navmesh(path, triangulated(rooms.map), rooms.labelled(),
                {.robot_radius = 0.1, .robot_height = 0.6});
  const LoadedNavmesh small(path);
  EXPECT_TRUE(small.can_stand({0.2, 2, 0}));
  EXPECT_TRUE(small.can_stand({7, 3.7, 0}));
}

TEST(Navmesh, IsClosedToARobotWiderThanTheDoor) {
  const TemporaryDirectory directory;
  const SmallMap rooms = two_rooms_with_a_door();
  write_navmesh(directory / "navmesh.bin", triangulated(rooms.map), rooms.labelled(),
                {.robot_radius = 0.6});
  const LoadedNavmesh mesh(directory / "navmesh.bin");
  EXPECT_TRUE(std::isnan(mesh.length_of_way({1, 2.5, 0}, {8, 1.5, 0})));
}

TEST(Navmesh, IsTheSameForAnyNumberOfThreads) {
  const TemporaryDirectory directory;
  const SmallMap rooms = two_rooms_with_a_door();
  const int threads = thread_count();
  for (const int count : {1, 4}) {
    set_thread_count(count);
    write_navmesh(directory / fmt::format("{}.bin", count), triangulated(rooms.map),
                  rooms.labelled());
  }
  set_thread_count(threads);
  EXPECT_EQ(text_of(directory / "1.bin"), text_of(directory / "4.bin"));
}

TEST(Navmesh, RefusesWhatNoRobotCanUse) {
  const TemporaryDirectory directory;
  const auto path = directory / "navmesh.bin";
  const SmallMap rooms = two_rooms_with_a_door(), none;
  const TriangulatedMap mesh = triangulated(rooms.map);
  const auto message = [&](const TriangulatedMap& triangles, const LabelledMap& map,
                           const NavmeshParams& params = {}) {
    return error_of([&] { write_navmesh(path, triangles, map, params); });
  };
  EXPECT_EQ(message({}, none.labelled()), path.string() + ": there is no floor for a robot");
  EXPECT_EQ(message(mesh, rooms.labelled(), {.robot_radius = 3}),
            path.string() + ": no floor is wide and high enough for the robot");
  EXPECT_EQ(message(mesh, rooms.labelled(), {.robot_height = 0.1, .robot_climb = 0.2}),
            path.string() + ": a robot cannot be 0.1 m high and drive over 0.2 m");
  EXPECT_EQ(message(mesh, rooms.labelled(), {.cell = 0}),
            path.string() + ": cells cannot have 0 x 0.025 m");
  EXPECT_EQ(message(mesh, rooms.labelled(), {.cell = 0.0003}),
            path.string() +
                ": a map of 9 x 5 x 2 m has too many cells of 0.0003 m for Recast and "
                "Detour");
  EXPECT_NE(message({}, rooms.labelled(), {}), "");
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace planum
