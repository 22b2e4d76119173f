#include "meshing/polygons.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "meshing/geos_polygons.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scenes.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;

PolygonMap polygons_of(const TriangleMesh& mesh, double cell) {
  return polygonize(mesh, grow_planes(mesh, region_params(cell)), polygon_params(cell));
}

std::vector<Ring2d> flat(const PolygonMap& map, const MapPolygon& polygon) {
  const PlaneFrame frame(polygon.plane);
  std::vector<Ring2d> rings(1);
  for (const std::uint32_t v : polygon.outer) rings[0].push_back(frame.flat(map.vertices[v]));
  for (const Ring& hole : polygon.holes) {
    rings.emplace_back();
    for (const std::uint32_t v : hole) rings.back().push_back(frame.flat(map.vertices[v]));
  }
  return rings;
}

/// What holds for every polygon map.
void expect_laws(const PolygonMap& map) {
  for (const MapPolygon& polygon : map.polygons) {
    const std::vector<Ring2d> rings = flat(map, polygon);
    EXPECT_TRUE(is_valid_polygon(rings)) << polygon.area << " m^2";
    double sum = 0;
    for (std::size_t r = 0; r < rings.size(); ++r) {
      const double area = signed_area(rings[r]);
      EXPECT_EQ(area > 0, r == 0);
      sum += area;
    }
    EXPECT_NEAR(polygon.area, sum, 1e-9 * sum);
    std::vector<Ring> all{polygon.outer};
    all.insert(all.end(), polygon.holes.begin(), polygon.holes.end());
    for (const Ring& ring : all) {
      EXPECT_EQ(std::set<std::uint32_t>(ring.begin(), ring.end()).size(), ring.size());
      for (const std::uint32_t v : ring)
        EXPECT_LT(std::abs(polygon.plane.signed_distance(map.vertices[v])), 6e-4);
    }
  }
  std::set<std::set<std::uint32_t>> rest;
  for (const auto& t : map.rest.triangles)
    EXPECT_TRUE(rest.insert({t[0], t[1], t[2]}).second) << "a triangle of the rest is there twice";
  const TriangulatedMap triangles = triangulated(map);
  std::vector<double> area(map.polygons.size(), 0);
  for (std::size_t i = 0; i < triangles.mesh.triangles.size(); ++i) {
    if (triangles.polygon[i] == TriangulatedMap::rest) continue;
    const PlaneFrame frame(map.polygons[triangles.polygon[i]].plane);
    Ring2d corners;
    for (const std::uint32_t v : triangles.mesh.triangles[i])
      corners.push_back(frame.flat(map.vertices[v]));
    EXPECT_GE(signed_area(corners), -1e-12);
    area[triangles.polygon[i]] += signed_area(corners);
  }
  for (std::size_t i = 0; i < area.size(); ++i)
    EXPECT_NEAR(area[i], map.polygons[i].area, 1e-6 * area[i]);
}

/// Edges of polygons that are not between two polygons.
std::size_t lonely_edges(const PolygonMap& map) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const MapPolygon& polygon : map.polygons) {
    std::vector<Ring> all{polygon.outer};
    all.insert(all.end(), polygon.holes.begin(), polygon.holes.end());
    for (const Ring& ring : all)
      for (std::size_t i = 0; i < ring.size(); ++i)
        ++uses[std::minmax(ring[i], ring[(i + 1) % ring.size()])];
  }
  return static_cast<std::size_t>(
      std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second != 2; }));
}

TEST(Polygons, OfABoxShareItsEightCorners) {
  const Vector3d size(4.03, 3.11, 2.52);
  TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
  testing::add_noise(mesh, 0.004, 1);
  const PolygonMap map = polygons_of(mesh, 0.1);
  expect_laws(map);
  ASSERT_EQ(map.polygons.size(), 6u);
  EXPECT_EQ(map.vertices.size(), 8u);
  EXPECT_EQ(lonely_edges(map), 0u);
  EXPECT_TRUE(map.rest.triangles.empty());
  for (const MapPolygon& polygon : map.polygons) {
    EXPECT_EQ(polygon.outer.size(), 4u);
    EXPECT_TRUE(polygon.holes.empty());
  }
  for (const Vector3d& v : map.vertices)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(std::min(std::abs(v[k]), std::abs(v[k] - size[k])), 0.006);
}

TEST(Polygons, OfTwoRoomsHaveAStraightDoor) {
  TriangleMesh mesh = testing::two_rooms_mesh(0.05);
  testing::add_noise(mesh, 0.003, 2);
  const PolygonMap map = polygons_of(mesh, 0.05);
  expect_laws(map);
  // 5 sides and the wall of the door for each room, two floors and ceilings less one floor, two
  // jambs and the lintel.
  EXPECT_EQ(map.polygons.size(), 1u + 2u * 5u + 3u);
  EXPECT_EQ(lonely_edges(map), 0u);
  EXPECT_TRUE(map.rest.triangles.empty());
  const TriangulatedMap triangles = triangulated(map);
  EXPECT_EQ(testing::open_edges(triangles.mesh), 0u);
  // Walls with the door cut out have eight corners, the floor twelve.
  std::multiset<std::size_t> corners;
  for (const MapPolygon& polygon : map.polygons) corners.insert(polygon.outer.size());
  EXPECT_EQ(corners.count(8), 2u);
  EXPECT_EQ(corners.count(12), 1u);
  EXPECT_EQ(corners.count(4), 11u);
  for (const Vector3d& v : map.vertices)
    if (v.x() > 2.9 && v.x() < 3.3 && v.y() > 0.5 && v.y() < 2.5) {
      EXPECT_LT(std::min(std::abs(v.y() - 1), std::abs(v.y() - 1.9)), 0.01);
      EXPECT_LT(std::min(std::abs(v.z()), std::abs(v.z() - 2)), 0.01);
    }
}

TEST(Polygons, HaveHolesWhereThingsStandOnThem) {
  TriangleMesh mesh = testing::furnished_room_mesh(0.05);
  testing::add_noise(mesh, 0.002, 3);
  const PolygonMap map = polygons_of(mesh, 0.05);
  expect_laws(map);
  ASSERT_EQ(map.polygons.size(), 11u);
  std::map<std::size_t, int> with_holes;
  for (const MapPolygon& polygon : map.polygons) ++with_holes[polygon.holes.size()];
  EXPECT_EQ(with_holes[2], 1);  // the floor: column and box
  EXPECT_EQ(with_holes[1], 1);  // the ceiling: column
  EXPECT_GT(map.rest.triangles.size(), 20u);
  // Column and planes are one closed surface of the right size.
  const TriangulatedMap triangles = triangulated(map);
  EXPECT_EQ(testing::open_edges(triangles.mesh), 0u);
  const double room = 4 * 4 * 2.4 - 0.75 * 1.2 - pi * 0.22 * 0.22 * 2.4;
  EXPECT_NEAR(testing::signed_volume(triangles.mesh), -room, 0.005 * room);
}

TEST(Polygons, OfPlanesThatDoNotMeetAreJoinedByTheRest) {
  // Two levels 7 cm apart: too close for a plane of its own between them.
  TriangleMesh mesh = testing::step_mesh(0.07, 0.05);
  testing::add_noise(mesh, 0.002, 4);
  const PolygonMap map = polygons_of(mesh, 0.05);
  expect_laws(map);
  const TriangulatedMap triangles = triangulated(map);
  EXPECT_EQ(testing::open_edges(triangles.mesh), 0u);
  EXPECT_NEAR(testing::signed_volume(triangles.mesh), -(4 * 3 * 2.4 + 2 * 3 * 0.07), 0.1);
}

TEST(Polygons, TurnWithTheScene) {
  TriangleMesh mesh = testing::furnished_room_mesh(0.1);
  testing::add_noise(mesh, 0.003, 5);
  const PolygonMap before = polygons_of(mesh, 0.1);
  const Pose pose = testing::some_pose(0.35);
  const PolygonMap after = polygons_of(testing::moved(mesh, pose), 0.1);
  expect_laws(after);
  ASSERT_EQ(after.polygons.size(), before.polygons.size());
  for (std::size_t i = 0; i < before.polygons.size(); ++i) {
    EXPECT_NEAR(after.polygons[i].area, before.polygons[i].area, 0.01);
    EXPECT_GT(after.polygons[i].plane.normal.dot(pose.linear() * before.polygons[i].plane.normal),
              std::cos(radians(0.3)));
  }
}

TEST(Polygons, AreTheSameForAnyNumberOfThreads) {
  TriangleMesh mesh = testing::furnished_room_mesh(0.1);
  testing::add_noise(mesh, 0.01, 6);
  const Regions regions = grow_planes(mesh, region_params(0.1));
  set_thread_count(1);
  const PolygonMap one = polygonize(mesh, regions, polygon_params(0.1));
  set_thread_count(4);
  const PolygonMap four = polygonize(mesh, regions, polygon_params(0.1));
  set_thread_count(0);
  EXPECT_EQ(one.vertices, four.vertices);
  ASSERT_EQ(one.polygons.size(), four.polygons.size());
  for (std::size_t i = 0; i < one.polygons.size(); ++i) {
    EXPECT_EQ(one.polygons[i].outer, four.polygons[i].outer);
    EXPECT_EQ(one.polygons[i].holes, four.polygons[i].holes);
    EXPECT_EQ(one.polygons[i].area, four.polygons[i].area);
  }
  EXPECT_EQ(one.rest.triangles, four.rest.triangles);
}

TEST(Polygons, AreValidHoweverNoisyTheMeshIs) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    TriangleMesh mesh = testing::furnished_room_mesh(0.1);
    testing::add_noise(mesh, 0.002 + 0.004 * seed, seed);
    // Holes all over.
    std::mt19937 random(seed);
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 40 < seed; });
    expect_laws(polygons_of(mesh, 0.1));
  }
}

/// A wall with panels a few centimetres before it and lumps all over, seen from above.
TriangleMesh panelled_wall(unsigned seed) {
  constexpr std::uint32_t columns = 80, rows = 60;
  constexpr double cell = 0.05;
  std::mt19937 random(seed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<double> height(columns * rows, 0);
  const auto raise = [&](std::uint32_t at_most, double by) {
    const std::uint32_t x = random() % columns, y = random() % rows;
    const std::uint32_t width = 1 + random() % at_most, depth = 1 + random() % at_most;
    for (std::uint32_t j = y; j < std::min(rows, y + depth); ++j)
      for (std::uint32_t i = x; i < std::min(columns, x + width); ++i)
        height[j * columns + i] += by;
  };
  for (int panel = 0; panel < 12; ++panel) raise(20, draw(0.01, 0.06));
  for (int lump = 0; lump < 40; ++lump) {
    const std::uint32_t x = random() % columns, y = random() % rows;
    for (std::uint32_t j = y; j < std::min(rows, y + 6); ++j)
      for (std::uint32_t i = x; i < std::min(columns, x + 6); ++i)
        height[j * columns + i] += draw(0, 0.3);
  }
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const Vector3d v(cell * i, cell * j, height[j * columns + i]);
      mesh.vertices.push_back(v.cast<float>());
      if (i == 0 || j == 0) continue;
      const std::uint32_t d = j * columns + i, c = d - 1, b = d - columns, a = b - 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  testing::add_noise(mesh, 0.001, seed);
  return mesh;
}

TEST(Polygons, OfPanelsLieInTheirPlanesHoweverRoughTheirSteps) {
  for (unsigned seed = 0; seed < 20; ++seed) expect_laws(polygons_of(panelled_wall(seed), 0.05));
}

TEST(Polygons, CloseSmallHolesAndKeepLargeOnes) {
  TriangleMesh mesh = testing::box_room_mesh({4, 3, 2.5}, 0.1);
  const auto is_in_hole = [&](const std::array<std::uint32_t, 3>& t) {
    const Vector3d p = mesh.vertices[t[0]].cast<double>();
    return p.z() < 0.05 &&
           ((p - Vector3d(1, 1.5, 0)).norm() < 0.15 || (p - Vector3d(3, 1.5, 0)).norm() < 0.6);
  };
  std::erase_if(mesh.triangles, is_in_hole);
  const PolygonMap map = polygons_of(mesh, 0.1);
  expect_laws(map);
  ASSERT_EQ(map.polygons.size(), 6u);
  std::size_t holes = 0;
  for (const MapPolygon& polygon : map.polygons) holes += polygon.holes.size();
  EXPECT_EQ(holes, 1u);
}

TEST(Polygons, SurviveAnyTriangles) {
  std::mt19937 random(12);
  const auto number = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  for (int draw = 0; draw < 60; ++draw) {
    TriangleMesh mesh;
    for (int i = 0; i < 40; ++i)
      mesh.vertices.emplace_back(number(), number(), draw % 3 ? 0.02f * number() : number());
    for (int i = 0; i < 150; ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(random() % 40),
                                static_cast<std::uint32_t>(random() % 40),
                                static_cast<std::uint32_t>(random() % 40)});
    mesh.triangles.push_back(mesh.triangles.front());
    expect_laws(polygonize(mesh, grow_planes(mesh, {.min_area = 0})));
  }
  EXPECT_TRUE(polygonize({}, {}).polygons.empty());
}

TEST(Polygons, SayWhatIsWrong) {
  const TriangleMesh mesh = testing::box_room_mesh({2, 2, 2}, 0.2);
  try {
    polygonize(mesh, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "polygons: the regions are of a mesh of 0 triangles, this one has " +
                  std::to_string(mesh.triangles.size()));
  }
  EXPECT_THROW(polygonize({}, {}, {.max_error = -1}), Error);
}

}  // namespace
}  // namespace planum
