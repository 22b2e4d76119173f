#include "slam/sensor/plan_polygon.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/pose.hpp"
#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

const PlanPolygon ring{.outer = {{0, 0}, {6, 0}, {6, 4}, {0, 4}},
                       .holes = {{{2, 1}, {4, 1}, {4, 3}, {2, 3}}}};

double sum_of_areas(const PlanPolygon& polygon) {
  double sum = 0;
  for (const auto& [a, b, c] : triangulated(polygon)) {
    const double twice = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    EXPECT_GT(twice, 0) << "clockwise";
    sum += twice / 2;
  }
  return sum;
}

TEST(PlanPolygon, TrianglesFillIt) {
  EXPECT_DOUBLE_EQ(area(ring), 20);
  EXPECT_NEAR(sum_of_areas(ring), 20, 1e-12);
  EXPECT_EQ(triangulated(ring).size(), 8u);
}

TEST(PlanPolygon, TrianglesFillRandomStars) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> radius(0.5, 3);
  for (int round = 0; round < 50; ++round) {
    PlanPolygon star;
    for (int i = 0; i < 25; ++i)
      star.outer.push_back(radius(random) *
                           Eigen::Vector2d(std::cos(2 * pi * i / 25), std::sin(2 * pi * i / 25)));
    star.holes = {{{0.1, 0}, {0, 0.1}, {-0.1, -0.1}}};
    EXPECT_NEAR(sum_of_areas(star), area(star), 1e-9);
    EXPECT_EQ(triangulated(star).size(), 28u);  // corners + 2 holes - 2
  }
}

TEST(PlanPolygon, CornersInAStraightLineAreUsed) {
  PlanPolygon square{.outer = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}};
  EXPECT_EQ(triangulated(square).size(), 3u);
}

TEST(PlanPolygon, RingsTurnWithTheInsideToTheLeft) {
  PlanPolygon backwards = ring;
  std::reverse(backwards.outer.begin(), backwards.outer.end());
  const PlanPolygon result = oriented(backwards);
  EXPECT_EQ(result.outer, ring.outer);
  EXPECT_EQ(result.holes[0][0], Eigen::Vector2d(2, 3));  // was counter-clockwise
}

TEST(PlanPolygon, SmallestRectangleTurnsWithIt) {
  for (const double angle : {0.0, 0.4, 2.0, -1.2}) {
    const Eigen::Rotation2Dd rotation(angle);
    PlanPolygon turned;
    for (const Eigen::Vector2d& corner : ring.outer) turned.outer.push_back(rotation * corner);
    const PlanRectangle rectangle = smallest_rectangle(turned);
    EXPECT_NEAR(rectangle.width, 4, 1e-12);
    EXPECT_NEAR(rectangle.depth, 6, 1e-12);
    EXPECT_LT((rectangle.centre - rotation * Eigen::Vector2d(3, 2)).norm(), 1e-12);
  }
}

TEST(PlanPolygon, RefusesRingsThatAreNone) {
  EXPECT_EQ(message_of([] {
              triangulated({.outer = {{0, 0}, {1, 0}}});
            }),
            "a ring of 2 corners has no area");
  EXPECT_EQ(message_of([] {
              triangulated({.outer = {{0, 0}, {3, 0}, {0, 2}, {2, 2}}});
            }),
            "the rings of the polygon cross or touch");
}

}  // namespace
}  // namespace planum
