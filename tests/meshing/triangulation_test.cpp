#include "meshing/triangulation.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "meshing/ear_clipping.hpp"
#include "meshing/geos_polygons.hpp"
#include "meshing/plane_geometry.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// A ring around a centre with random radii; clockwise if asked for.
Ring2d star(std::mt19937& random, const Vector2d& centre, double low, double high,
            std::size_t count, bool clockwise) {
  std::uniform_real_distribution<double> radius(low, high);
  Ring2d ring;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(count);
    ring.push_back(centre + radius(random) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  if (clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// An outer ring and holes that do not touch.
std::vector<Ring2d> random_polygon(std::mt19937& random) {
  std::vector<Ring2d> rings{star(random, Vector2d::Zero(), 4, 6, 5 + random() % 40, false)};
  const std::size_t holes = random() % 5;
  for (std::size_t h = 0; h < holes; ++h) {
    const double angle = 2 * pi * static_cast<double>(h) / static_cast<double>(holes);
    rings.push_back(star(random, 1.8 * Vector2d(std::cos(angle), std::sin(angle)), 0.2, 0.8,
                         3 + random() % 10, true));
  }
  return rings;
}

double area_of(const std::vector<Ring2d>& rings) {
  double sum = 0;
  for (const Ring2d& ring : rings) sum += signed_area(ring);
  return sum;
}

void expect_covers(const Triangles& triangles, const std::vector<Ring2d>& rings) {
  Ring2d points;
  for (const Ring2d& ring : rings) points.insert(points.end(), ring.begin(), ring.end());
  // A polygon of n vertices and h holes has n + 2 h - 2 triangles.
  EXPECT_EQ(triangles.size(), points.size() + 2 * (rings.size() - 1) - 2);
  double sum = 0;
  for (const auto& t : triangles) {
    const double area = signed_area(Ring2d{points.at(t[0]), points.at(t[1]), points.at(t[2])});
    EXPECT_GE(area, 0);
    sum += area;
  }
  EXPECT_NEAR(sum, area_of(rings), 1e-9 * sum);
}

TEST(Triangulation, ByDelaunayCoversPolygonsWithHoles) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 200; ++draw) {
    const std::vector<Ring2d> rings = random_polygon(random);
    const auto triangles = constrained_delaunay(rings);
    ASSERT_TRUE(triangles);
    expect_covers(*triangles, rings);
  }
}

TEST(Triangulation, ByEarsCoversPolygonsWithHoles) {
  std::mt19937 random(2);
  for (int draw = 0; draw < 200; ++draw) {
    const std::vector<Ring2d> rings = random_polygon(random);
    expect_covers(clipped_ears(rings), rings);
  }
}

TEST(Triangulation, ByEarsTakesVerticesInARow) {
  const Ring2d square{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}};
  const Ring2d hole{{1, 1}, {1, 1.5}, {1, 2}, {2, 2}, {2, 1}};
  expect_covers(clipped_ears(std::vector<Ring2d>{square, hole}), {square, hole});
}

TEST(Triangulation, ByEarsEndsWhereRingsCross) {
  const Ring2d bow{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_EQ(clipped_ears(std::vector<Ring2d>{bow}).size(), 2u);
  EXPECT_TRUE(clipped_ears(std::vector<Ring2d>{}).empty());
}

MapPolygon add_polygon(PolygonMap& map, const Plane& plane, const std::vector<Ring2d>& rings) {
  const PlaneFrame frame(plane);
  MapPolygon polygon{plane, {}, {}, area_of(rings)};
  for (std::size_t r = 0; r < rings.size(); ++r) {
    Ring ring;
    for (const Vector2d& p : rings[r]) {
      ring.push_back(static_cast<std::uint32_t>(map.vertices.size()));
      map.vertices.push_back(frame.raised(p));
    }
    if (r == 0)
      polygon.outer = ring;
    else
      polygon.holes.push_back(ring);
  }
  map.polygons.push_back(polygon);
  return polygon;
}

TEST(Triangulation, OfAMapKeepsAreaNormalsAndVertices) {
  std::mt19937 random(3);
  PolygonMap map;
  for (int i = 0; i < 20; ++i) {
    const Vector3d normal = Vector3d::Random().normalized();
    add_polygon(map, {normal, 0.3 * i}, random_polygon(random));
  }
  const TriangulatedMap result = triangulated(map);
  ASSERT_EQ(result.polygon.size(), result.mesh.triangles.size());
  ASSERT_EQ(result.mesh.vertices.size(), map.vertices.size());
  std::vector<double> area(map.polygons.size(), 0);
  for (std::size_t i = 0; i < result.polygon.size(); ++i) {
    const auto& t = result.mesh.triangles[i];
    const Vector3d a = map.vertices[t[0]], b = map.vertices[t[1]], c = map.vertices[t[2]];
    const double signed_size =
        (b - a).cross(c - a).dot(map.polygons[result.polygon[i]].plane.normal) / 2;
    EXPECT_GE(signed_size, -1e-12);
    area[result.polygon[i]] += signed_size;
  }
  for (std::size_t i = 0; i < area.size(); ++i)
    EXPECT_NEAR(area[i], map.polygons[i].area, 1e-6 * map.polygons[i].area);
}

TEST(Triangulation, JoinsTheRestToThePolygons) {
  PolygonMap map;
  add_polygon(map, {Vector3d::UnitZ(), 0}, {Ring2d{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  const auto corner = [&](std::size_t i) { return map.vertices[i].cast<float>(); };
  map.rest.vertices = {corner(1), corner(0), Eigen::Vector3f(0.5f, 0.5f, 1)};
  map.rest.triangles = {{0, 1, 2}};
  const TriangulatedMap result = triangulated(map);
  EXPECT_EQ(result.mesh.vertices.size(), 5u);
  ASSERT_EQ(result.mesh.triangles.size(), 3u);
  EXPECT_EQ(result.mesh.triangles.back(), (std::array<std::uint32_t, 3>{1, 0, 4}));
  EXPECT_EQ(result.polygon.back(), TriangulatedMap::rest);
}

TEST(Triangulation, OfAnEmptyMapIsEmpty) { EXPECT_TRUE(triangulated({}).mesh.triangles.empty()); }

TEST(ValidPolygon, KnowsCrossingsAndHolesOutside) {
  const Ring2d square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  const Ring2d inside{{1, 1}, {1, 2}, {2, 2}, {2, 1}}, across{{3, 1}, {3, 2}, {5, 2}, {5, 1}};
  EXPECT_TRUE(is_valid_polygon(std::vector<Ring2d>{square}));
  EXPECT_TRUE(is_valid_polygon(std::vector<Ring2d>{square, inside}));
  EXPECT_FALSE(is_valid_polygon(std::vector<Ring2d>{square, across}));
  EXPECT_FALSE(is_valid_polygon(std::vector<Ring2d>{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}));
  EXPECT_FALSE(is_valid_polygon(std::vector<Ring2d>{Ring2d{{0, 0}, {1, 1}}}));
  EXPECT_FALSE(is_valid_polygon({}));
}

TEST(ValidPolygon, IsMadeOfAnyRing) {
  const std::vector<Ring2d> bow{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}};
  const auto pieces = made_valid(bow);
  ASSERT_EQ(pieces.size(), 2u);
  for (const auto& piece : pieces) EXPECT_NEAR(area_of(piece), 1, 1e-12);
}

TEST(Triangulation, LeavesOutTrianglesOfTheRestWhoseCornersAreOnePlace) {
  PolygonMap map;
  map.rest.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  map.rest.triangles = {{0, 1, 2}, {0, 1, 3}};
  const TriangulatedMap result = triangulated(map);
  ASSERT_EQ(result.mesh.triangles.size(), 1u);
  EXPECT_EQ(result.polygon.size(), 1u);
  EXPECT_EQ(result.inferred.size(), 1u);
  EXPECT_EQ(result.mesh.vertices.size(), 3u);
}

}  // namespace
}  // namespace planum
