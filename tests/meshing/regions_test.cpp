#include "meshing/regions.hpp"

#include <set>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scenes.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;

std::size_t rest_triangles(const Regions& regions) {
  return static_cast<std::size_t>(
      std::count(regions.of_triangle.begin(), regions.of_triangle.end(), Regions::rest));
}

void expect_partition(const Regions& regions, const TriangleMesh& mesh) {
  ASSERT_EQ(regions.of_triangle.size(), mesh.triangles.size());
  std::set<std::uint32_t> seen;
  for (const std::uint32_t r : regions.of_triangle)
    if (r != Regions::rest) {
      ASSERT_LT(r, regions.regions.size());
      seen.insert(r);
    }
  EXPECT_EQ(seen.size(), regions.regions.size());
  for (std::size_t i = 1; i < regions.regions.size(); ++i)
    EXPECT_GE(regions.regions[i - 1].area, regions.regions[i].area);
}

TEST(Regions, OfANoisyRoomAreItsSixSides) {
  const Vector3d size(4.03, 3.11, 2.52);
  for (const unsigned seed : {1u, 2u, 3u}) {
    TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
    testing::add_noise(mesh, 0.004, seed);
    const Regions regions = grow_planes(mesh, region_params(0.1));
    expect_partition(regions, mesh);
    ASSERT_EQ(regions.regions.size(), 6u);
    for (const Region& region : regions.regions) {
      int axis;
      const double alignment = region.plane.normal.cwiseAbs().maxCoeff(&axis);
      EXPECT_GT(alignment, std::cos(radians(0.4)));
      // Normals look inside: the low sides have offset 0, the high ones minus their place.
      const double place = region.plane.normal[axis] > 0 ? 0 : -size[axis];
      const Vector3d middle = size / 2;
      const double at_middle = region.plane.offset - region.plane.normal.dot(middle) +
                               region.plane.normal[axis] * middle[axis];
      EXPECT_NEAR(at_middle, place, 0.003);
    }
    EXPECT_LT(rest_triangles(regions), mesh.triangles.size() / 5);
  }
}

TEST(Regions, OfACubeOfTwelveTrianglesAreItsSixSides) {
  TriangleMesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.emplace_back(static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                               static_cast<float>(i >> 2));
  cube.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const Regions regions = grow_planes(cube);
  ASSERT_EQ(regions.regions.size(), 6u);
  EXPECT_EQ(rest_triangles(regions), 0u);
  for (const Region& region : regions.regions) EXPECT_NEAR(region.area, 1, 1e-6);
}

TEST(Regions, LeaveAColumnItsTriangles) {
  const TriangleMesh mesh = testing::furnished_room_mesh(0.05);
  const Regions regions = grow_planes(mesh);
  EXPECT_EQ(regions.regions.size(), 6u + 5u);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Vector3d p = mesh.vertices[mesh.triangles[f][0]].cast<double>();
    if (std::hypot(p.x() - 1, p.y() - 1) < 0.25 && p.z() > 0.3 && p.z() < 2.1) {
      EXPECT_EQ(regions.of_triangle[f], Regions::rest);
    }
  }
}

TEST(Regions, JoinTheFloorsOfTwoRooms) {
  TriangleMesh mesh = testing::two_rooms_mesh(0.1);
  testing::add_noise(mesh, 0.004, 5);
  const Regions regions = grow_planes(mesh, region_params(0.1));
  std::size_t floors = 0;
  for (const Region& region : regions.regions)
    floors += region.plane.normal.z() > 0.9 && std::abs(region.plane.offset) < 0.02;
  EXPECT_EQ(floors, 1u);
}

TEST(Regions, KeepTheLevelsOfAStepApart) {
  const Regions regions = grow_planes(testing::step_mesh(0.15, 0.05));
  std::multiset<double> levels;
  for (const Region& region : regions.regions)
    if (region.plane.normal.z() > 0.9) levels.insert(region.plane.offset);
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_NEAR(*levels.begin(), -0.15, 0.004);
  EXPECT_NEAR(*levels.rbegin(), 0, 0.004);
}

TEST(Regions, TurnWithTheScene) {
  TriangleMesh mesh = testing::two_rooms_mesh(0.1);
  testing::add_noise(mesh, 0.004, 6);
  const RegionParams params = region_params(0.1);
  const Regions before = grow_planes(mesh, params);
  for (const double angle : {0.1, 0.35, 2.0}) {
    const Pose pose = testing::some_pose(angle);
    const Regions after = grow_planes(testing::moved(mesh, pose), params);
    ASSERT_EQ(after.regions.size(), before.regions.size());
    for (std::size_t i = 0; i < before.regions.size(); ++i) {
      EXPECT_NEAR(after.regions[i].area, before.regions[i].area, 0.02 * before.regions[i].area);
      const Vector3d normal = pose.linear() * before.regions[i].plane.normal;
      EXPECT_GT(after.regions[i].plane.normal.dot(normal), std::cos(radians(0.5)));
    }
  }
}

TEST(Regions, AreTheSameForAnyNumberOfThreads) {
  TriangleMesh mesh = testing::furnished_room_mesh(0.05);
  testing::add_noise(mesh, 0.003, 7);
  set_thread_count(1);
  const Regions one = grow_planes(mesh);
  set_thread_count(4);
  const Regions four = grow_planes(mesh);
  set_thread_count(0);
  EXPECT_EQ(one.of_triangle, four.of_triangle);
  ASSERT_EQ(one.regions.size(), four.regions.size());
  for (std::size_t i = 0; i < one.regions.size(); ++i) {
    EXPECT_EQ(one.regions[i].plane.normal, four.regions[i].plane.normal);
    EXPECT_EQ(one.regions[i].plane.offset, four.regions[i].plane.offset);
  }
}

TEST(Regions, SurviveAnyTriangles) {
  std::mt19937 random(11);
  const auto number = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  for (int draw = 0; draw < 50; ++draw) {
    TriangleMesh mesh;
    for (int i = 0; i < 40; ++i) mesh.vertices.emplace_back(number(), number(), number());
    if (draw % 2) std::fill(mesh.vertices.begin() + 20, mesh.vertices.end(), mesh.vertices[0]);
    for (int i = 0; i < 150; ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(random() % 40),
                                static_cast<std::uint32_t>(random() % 40),
                                static_cast<std::uint32_t>(random() % 40)});
    mesh.triangles.push_back(mesh.triangles.front());
    expect_partition(grow_planes(mesh, {.min_area = 0}), mesh);
  }
  EXPECT_TRUE(grow_planes({}).regions.empty());
}

TEST(Regions, SayWhichParameterIsWrong) {
  try {
    grow_planes({}, {.max_distance = 0});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "regions: max_distance is 0.000000, must be above 0.000000");
  }
  EXPECT_THROW(grow_planes({}, {.min_area = -1}), Error);
  EXPECT_THROW(grow_planes({}, {.max_angle = NAN}), Error);
}

}  // namespace
}  // namespace planum
