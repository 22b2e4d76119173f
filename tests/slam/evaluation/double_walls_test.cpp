#include "slam/evaluation/double_walls.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

/// Adds an even, noisy rectangle; `u` and `v` are its sides.
void add_wall(Cloud& cloud, const Eigen::Vector3f& corner, const Eigen::Vector3f& u,
              const Eigen::Vector3f& v, double noise, std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> normal(0, 1);
  const Eigen::Vector3f n = u.cross(v).normalized();
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(corner + share(random) * u + share(random) * v +
                           static_cast<float>(noise) * normal(random) * n);
    cloud.normals.push_back(n);
  }
}

/// Two walls and a floor of a room, seen from inside.
Cloud room(double noise, unsigned seed) {
  std::mt19937 random(seed);
  Cloud cloud;
  add_wall(cloud, {0, 0, 0}, {4, 0, 0}, {0, 3, 0}, noise, 12000, random);
  add_wall(cloud, {0, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, noise, 8000, random);
  add_wall(cloud, {0, 0, 0}, {0, 0, 2.5}, {4, 0, 0}, noise, 10000, random);
  return cloud;
}

Cloud shifted(Cloud cloud, const Eigen::Vector3f& by) {
  for (Eigen::Vector3f& p : cloud.points) p += by;
  return cloud;
}

TEST(DoubleWalls, RecoversAShiftExactly) {
  const Cloud first = room(0, 1);
  const Eigen::Vector3f shift(0.03f, -0.02f, 0.05f);
  const auto gaps = double_walls(first, shifted(room(0, 2), shift));
  ASSERT_GT(gaps.size(), 100u);
  for (const DoubleWallPatch& patch : gaps)
    EXPECT_NEAR(patch.gap, patch.normal.dot(shift.cast<double>()), 2e-6);
}

TEST(DoubleWalls, OfAPerfectMapIsNoiseOverTheRootOfThePoints) {
  const double noise = 0.01;
  const DoubleWallGap gap = double_wall_gap(double_walls(room(noise, 3), room(noise, 4)));
  ASSERT_GT(gap.patches, 100u);
  // About 1000 points/m^2 on 0.2 m^2, for each of the two.
  const double expected = noise * std::sqrt(2.0 / 200);
  EXPECT_LT(gap.mean, 1.5 * expected);
  EXPECT_LT(gap.percentile_90, 3 * expected);
  EXPECT_LT(gap.max, 8 * expected);
}

TEST(DoubleWalls, RecoversAShiftUnderNoiseAndStrayPoints) {
  Cloud second = shifted(room(0.01, 5), {0, 0, 0.04f});
  std::mt19937 random(6);
  std::uniform_real_distribution<float> place(0, 2.5);
  for (int i = 0; i < 1500; ++i) {
    second.points.emplace_back(place(random), place(random), place(random));
    second.normals.push_back(second.normals[static_cast<std::size_t>(i) * 20]);
  }
  double sum = 0, count = 0;
  for (const DoubleWallPatch& patch : double_walls(room(0.01, 7), second)) {
    if (patch.normal.z() < 0.9) continue;
    sum += patch.gap;
    ++count;
  }
  ASSERT_GT(count, 50);
  EXPECT_NEAR(sum / count, 0.04, 0.001);
}

TEST(DoubleWalls, IsNotFooledByTheSidesOfAThinWall) {
  std::mt19937 random(8);
  Cloud front, back;
  add_wall(front, {0, 0, 0}, {3, 0, 0}, {0, 2.5, 0}, 0.005, 8000, random);
  add_wall(back, {0, 0, -0.08f}, {0, 2.5, 0}, {3, 0, 0}, 0.005, 8000, random);
  EXPECT_TRUE(double_walls(front, back).empty());
}

TEST(DoubleWalls, IsNotFooledByFurnitureInFrontOfAWall) {
  std::mt19937 random(9);
  Cloud first, second;
  // Both see the cupboard, only the first one sees the wall behind it.
  add_wall(first, {0, 0, 0}, {3, 0, 0}, {0, 2.5, 0}, 0.005, 8000, random);
  for (Cloud* cloud : {&first, &second})
    add_wall(*cloud, {1, 0, 0.2f}, {1, 0, 0}, {0, 2, 0}, 0.005, 4000, random);
  const DoubleWallGap gap = double_wall_gap(double_walls(first, second));
  ASSERT_GT(gap.patches, 20u);
  EXPECT_LT(gap.max, 0.004);
}

TEST(DoubleWalls, LeavesOutWhatIsFartherThanTheLimit) {
  const Cloud first = room(0.005, 10);
  EXPECT_TRUE(
      double_walls(first, shifted(room(0.005, 11), {0.2f, 0.2f, 0.2f}), {.max_gap = 0.15}).empty());
}

TEST(DoubleWalls, DoesNotChangeWhenEverythingIsMoved) {
  const Cloud first = room(0.01, 12), second = shifted(room(0.01, 13), {0.02f, 0.02f, 0.02f});
  const Pose elsewhere = pose_from_xyz_ypr({10, 20, -3}, 0.5, 0.3, 0.1);
  const DoubleWallGap here = double_wall_gap(double_walls(first, second));
  const DoubleWallGap there =
      double_wall_gap(double_walls(transformed(first, elsewhere), transformed(second, elsewhere)));
  // Patches begin elsewhere, so they agree as samples do.
  EXPECT_NEAR(here.median, there.median, 0.0005);
  EXPECT_NEAR(here.mean, there.mean, 0.0005);
}

TEST(DoubleWalls, IsTheSameForAnyNumberOfThreads) {
  const Cloud first = room(0.01, 14), second = room(0.01, 15);
  set_thread_count(1);
  const auto one = double_walls(first, second, {.max_patches = 200});
  set_thread_count(4);
  const auto many = double_walls(first, second, {.max_patches = 200});
  set_thread_count(0);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k) EXPECT_EQ(one[k].gap, many[k].gap);
}

TEST(DoubleWalls, SummaryHasAbsoluteValues) {
  std::vector<DoubleWallPatch> patches(4);
  for (std::size_t k = 0; k < 4; ++k)
    patches[k].gap = (k % 2 ? -1.0 : 1.0) * static_cast<double>(k);
  const DoubleWallGap gap = double_wall_gap(patches);
  EXPECT_EQ(gap.patches, 4u);
  EXPECT_DOUBLE_EQ(gap.median, 1.5);
  EXPECT_DOUBLE_EQ(gap.mean, 1.5);
  EXPECT_DOUBLE_EQ(gap.percentile_90, 2.7);
  EXPECT_DOUBLE_EQ(gap.max, 3);
  EXPECT_EQ(double_wall_gap({}).patches, 0u);
}

TEST(DoubleWalls, SaysWhatIsWrong) {
  const Cloud good = room(0.01, 16);
  Cloud bare = good;
  bare.normals.clear();
  EXPECT_THROW(double_walls(bare, good), Error);
  EXPECT_THROW(double_walls(good, bare), Error);
  EXPECT_THROW(double_walls(good, good, {.patch_radius = 0}), Error);
  EXPECT_THROW(double_walls(good, good, {.max_gap = -1}), Error);
  EXPECT_THROW(double_walls(good, good, {.max_normal_angle = 2}), Error);
  EXPECT_THROW(double_walls(good, good, {.min_points = 2}), Error);
  Cloud broken = good;
  broken.points[5].y() = INFINITY;
  EXPECT_THROW(double_walls(good, broken), Error);
  EXPECT_TRUE(double_walls({}, good).empty());
}

}  // namespace
}  // namespace planum
