#include "meshing/border_lenses.hpp"

#include <gtest/gtest.h>

namespace planum {
namespace {

/// A floor of 2 x 2 m whose border bulges at one side by `bulge`, and a wall that stands straight
/// there.
PolygonMap floor_and_wall(double bulge) {
  PolygonMap map;
  map.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2 + bulge, 0},
                  {0, 2, 0}, {2, 2, 2}, {0, 2, 2}};
  map.polygons = {{{Eigen::Vector3d::UnitZ(), 0}, {0, 1, 2, 3, 4}, {}, 4 + bulge},
                  {{-Eigen::Vector3d::UnitY(), -2}, {4, 2, 5, 6}, {}, 4}};
  return map;
}

TEST(BorderLenses, BetweenTwoPolygonsAreClosed) {
  for (const double bulge : {0.01, -0.01}) {
    PolygonMap map = floor_and_wall(bulge);
    close_lenses(map, 0.02);
    ASSERT_EQ(map.vertices.size(), 6u);
    EXPECT_EQ(map.polygons[0].outer, (Ring{0, 1, 2, 3}));
    EXPECT_EQ(map.polygons[1].outer, (Ring{3, 2, 4, 5}));
    EXPECT_EQ(map.vertices[3], Eigen::Vector3d(0, 2, 0));
    EXPECT_NEAR(map.polygons[0].area, 4, 1e-12);
  }
}

TEST(BorderLenses, StayWhereTheyAreLarge) {
  PolygonMap map = floor_and_wall(0.03);
  close_lenses(map, 0.02);
  EXPECT_EQ(map.polygons[0].outer.size(), 5u);
  EXPECT_EQ(map.vertices.size(), 7u);
}

TEST(BorderLenses, StayWhereTheRestFillsThem) {
  PolygonMap map = floor_and_wall(0.01);
  map.rest.vertices = {{2, 2, 0}, {1, 2.01f, 0}, {0, 2, 0}};
  map.rest.triangles = {{0, 2, 1}};
  close_lenses(map, 0.02);
  EXPECT_EQ(map.polygons[0].outer.size(), 5u);
}

TEST(BorderLenses, StayWhereThePolygonWouldCrossItself) {
  PolygonMap map = floor_and_wall(0.01);
  // A hole that reaches into the bulge.
  const auto first = static_cast<std::uint32_t>(map.vertices.size());
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(1, 2.005, 0), {1.02, 1.9, 0}, {0.98, 1.9, 0}})
    map.vertices.push_back(v);
  map.polygons[0].holes = {{first, first + 1, first + 2}};
  close_lenses(map, 0.02);
  EXPECT_EQ(map.polygons[0].outer.size(), 5u);
}

}  // namespace
}  // namespace planum
