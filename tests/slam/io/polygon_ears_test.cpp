#include "slam/io/polygon_ears.hpp"

#include <cmath>
#include <numeric>

#include "io_test_support.hpp"

namespace planum {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

Eigen::Vector3d area_vector(const std::vector<Eigen::Vector3f>& vertices, const Triangle& t) {
  const Eigen::Vector3d a = vertices[t[0]].cast<double>();
  return (vertices[t[1]].cast<double>() - a).cross(vertices[t[2]].cast<double>() - a) / 2;
}

struct Polygon {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::uint32_t> corners;
  double area = 0;
};

Polygon polygon_of(const std::vector<Eigen::Vector2d>& outline, const Pose& pose) {
  Polygon polygon;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    polygon.area += (a.x() * b.y() - a.y() * b.x()) / 2;
    polygon.vertices.push_back((pose * Eigen::Vector3d(a.x(), a.y(), 0)).cast<float>());
    polygon.corners.push_back(static_cast<std::uint32_t>(i));
  }
  return polygon;
}

/// The triangles have the polygon's orientation and cover its area once.
void expect_covered(const Polygon& polygon, const Eigen::Vector3d& normal) {
  const auto triangles = triangulated_polygon(polygon.vertices, polygon.corners);
  EXPECT_EQ(triangles.size(), polygon.corners.size() - 2);
  double area = 0, absolute_area = 0;
  for (const Triangle& t : triangles) {
    const double part = area_vector(polygon.vertices, t).dot(normal);
    area += part;
    absolute_area += std::abs(part);
  }
  EXPECT_NEAR(area, polygon.area, 1e-4 * polygon.area);
  EXPECT_NEAR(absolute_area, polygon.area, 1e-4 * polygon.area);
}

TEST(PolygonEars, CoverRandomStarShapedPolygonsOnce) {
  testing::Draws draws(8);
  for (int round = 0; round < 300; ++round) {
    const std::size_t corners = 3 + draws.below(40);
    std::vector<Eigen::Vector2d> outline;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(corners);
      outline.push_back(draws.uniform(1, 5) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    Pose pose = draws.pose();
    pose.translation() *= 0.1;
    expect_covered(polygon_of(outline, pose), pose.linear().col(2));
  }
}

TEST(PolygonEars, CoverACombAndCollinearCorners) {
  std::vector<Eigen::Vector2d> comb;
  for (int i = 0; i < 10; ++i) {
    comb.emplace_back(i, 0);
    comb.emplace_back(i, i % 2 ? 5 : 1);
    comb.emplace_back(i + 1, i % 2 ? 5 : 1);
  }
  comb.emplace_back(10, -1);
  comb.emplace_back(5, -1);
  comb.emplace_back(0, -1);
  std::vector<Eigen::Vector2d> outline(comb.rbegin(), comb.rend());
  const Pose pose = Pose::Identity();
  const std::vector<Eigen::Vector2d> arrow = {{0, 0}, {2, 0}, {2, 2}, {1, 0.5}, {0, 2}};
  expect_covered(polygon_of(arrow, pose), Eigen::Vector3d::UnitZ());
  const std::vector<Eigen::Vector2d> edges = {{0, 0}, {1, 0}, {2, 0}, {2, 1},
                                              {2, 2}, {1, 2}, {0, 2}, {0, 1}};
  expect_covered(polygon_of(edges, pose), Eigen::Vector3d::UnitZ());
}

TEST(PolygonEars, CoverAPolygonWithAHoleJoinedByACut) {
  // A square with a square hole; corners 0 and 4 are there twice.
  Polygon polygon;
  polygon.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                      {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
  polygon.corners = {0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
  polygon.area = 12;
  expect_covered(polygon, Eigen::Vector3d::UnitZ());
}

TEST(PolygonEars, GiveAsManyTrianglesForDegeneratePolygons) {
  const std::vector<Eigen::Vector3f> vertices = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  const auto count = [&](const std::vector<std::uint32_t>& corners) {
    return triangulated_polygon(vertices, corners).size();
  };
  EXPECT_EQ(count({0, 1, 2, 3}), 2u);  // crosses itself
  EXPECT_EQ(count({0, 0, 0, 0, 0}), 3u);
  EXPECT_EQ(count({0, 1, 0, 1}), 2u);
}

}  // namespace
}  // namespace planum
