#include "meshing/simplification.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace planum {
namespace {

using Eigen::Vector3d;

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double t =
      along.squaredNorm() > 0 ? std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
  return (p - a - t * along).norm();
}

/// Largest distance of a vertex from the part of the simplified line that stands for it.
double error(const Polyline& line, const std::vector<std::size_t>& kept, bool closed) {
  double worst = 0;
  for (std::size_t k = 0; k + 1 < kept.size() + closed; ++k) {
    const std::size_t a = kept[k];
    const std::size_t b = k + 1 < kept.size() ? kept[k + 1] : kept.front() + line.size();
    for (std::size_t i = a + 1; i < b; ++i)
      worst = std::max(worst,
                       distance_to_segment(line[i % line.size()], line[a], line[b % line.size()]));
  }
  return worst;
}

Polyline random_walk(std::mt19937& random, std::size_t count) {
  std::normal_distribution<double> step(0, 0.05);
  Polyline line{Vector3d::Zero()};
  while (line.size() < count)
    line.push_back(line.back() + Vector3d(0.05 + step(random), step(random), step(random)));
  return line;
}

TEST(Simplification, StaysWithinItsError) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 100; ++draw) {
    const Polyline line = random_walk(random, 2 + random() % 80);
    for (const double max_error : {0.0, 0.02, 0.1, 0.5})
      for (const bool closed : {false, true}) {
        const auto kept = kept_vertices({&line, 1}, max_error, closed);
        EXPECT_LE(error(line, kept, closed), max_error + 1e-12);
        EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
        if (closed) continue;
        EXPECT_EQ(kept.front(), 0u);
        EXPECT_EQ(kept.back(), line.size() - 1);
      }
  }
}

TEST(Simplification, LeavesOnlyTheEndsOfAStraightLine) {
  Polyline line;
  for (int i = 0; i <= 20; ++i) line.push_back(Vector3d(1, 2, -1) * (0.1 * i));
  EXPECT_EQ(simplified(line, 1e-9).size(), 2u);
}

TEST(Simplification, FindsTheCornersOfASquare) {
  Polyline square;
  const Vector3d corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < 10; ++i)
      square.push_back(corners[side] + 0.1 * i * (corners[(side + 1) % 4] - corners[side]));
  // Begin anywhere: the corners are found all the same.
  for (std::size_t shift = 0; shift < square.size(); shift += 3) {
    Polyline line = square;
    std::rotate(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(shift), line.end());
    const Polyline found = simplified(line, 0.01, true);
    ASSERT_EQ(found.size(), 4u);
    for (const Vector3d& p : found)
      EXPECT_EQ(std::count(std::begin(corners), std::end(corners), p), 1);
  }
}

TEST(Simplification, OfSeveralLinesKeepsWhatAnyOfThemNeeds) {
  std::mt19937 random(2);
  for (int draw = 0; draw < 50; ++draw) {
    const Polyline lines[] = {random_walk(random, 40), random_walk(random, 40)};
    const auto kept = kept_vertices(lines, 0.1);
    EXPECT_LE(error(lines[0], kept, false), 0.1 + 1e-12);
    EXPECT_LE(error(lines[1], kept, false), 0.1 + 1e-12);
  }
}

TEST(Simplification, TakesShortAndEmptyLines) {
  EXPECT_TRUE(simplified({}, 0.1).empty());
  EXPECT_EQ(simplified({Vector3d::Zero()}, 0.1).size(), 1u);
  EXPECT_EQ(simplified({Vector3d::Zero()}, 0.1, true).size(), 1u);
  EXPECT_EQ(simplified({Vector3d::Zero(), Vector3d::Ones()}, 10).size(), 2u);
}

}  // namespace
}  // namespace planum
