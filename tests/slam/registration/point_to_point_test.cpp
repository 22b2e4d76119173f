#include "slam/registration/point_to_point.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

std::vector<Pair> moved_pairs(const std::vector<Eigen::Vector3d>& points, const Pose& motion) {
  std::vector<Pair> pairs;
  for (const Eigen::Vector3d& p : points)
    pairs.push_back({.source = p, .target = motion * p, .normal = Eigen::Vector3d::Zero()});
  return pairs;
}

std::vector<Eigen::Vector3d> random_points(std::mt19937& random, const Eigen::Vector3d& extent) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Eigen::Vector3d> points(30);
  for (Eigen::Vector3d& p : points)
    p = extent.cwiseProduct(
            Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random))) +
        Eigen::Vector3d(3, -2, 1);
  return points;
}

TEST(ClosedFormMotion, RecoversAnyMotion) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose motion = testing::random_motion(random, 5, 3.1);
    const Pose found = closed_form_motion(moved_pairs(random_points(random, {1, 2, 3}), motion));
    EXPECT_TRUE(found.isApprox(motion, 1e-10));
  }
}

TEST(ClosedFormMotion, IsARotationForPointsOfAPlaneToo) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose motion = testing::random_motion(random, 1, 3.1);
    const Pose found = closed_form_motion(moved_pairs(random_points(random, {1, 2, 0}), motion));
    EXPECT_NEAR(found.linear().determinant(), 1, 1e-12);
    EXPECT_TRUE(found.isApprox(motion, 1e-8));
  }
}

TEST(ClosedFormMotion, NeverMirrors) {
  std::mt19937 random(3);
  std::vector<Pair> pairs;
  for (const Eigen::Vector3d& p : random_points(random, {1, 2, 3}))
    pairs.push_back({.source = p,
                     .target = Eigen::Vector3d(p.x(), p.y(), -p.z()),
                     .normal = Eigen::Vector3d::Zero()});
  EXPECT_NEAR(closed_form_motion(pairs).linear().determinant(), 1, 1e-12);
}

TEST(ClosedFormMotion, MinimizesForPointsOfALine) {
  std::mt19937 random(4);
  const auto pairs =
      moved_pairs(random_points(random, {1, 0, 0}), testing::random_motion(random, 1, 1));
  const Pose found = closed_form_motion(pairs);
  EXPECT_NEAR(found.linear().determinant(), 1, 1e-12);
  for (const Pair& pair : pairs) EXPECT_LT((found * pair.source - pair.target).norm(), 1e-8);
}

TEST(ClosedFormMotion, StaysWithoutPairs) {
  EXPECT_TRUE(closed_form_motion({}).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace planum
