#include "slam/registration/minimizers.hpp"

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

constexpr Minimizer closed_forms[] = {Minimizer::svd, Minimizer::quaternion,
                                      Minimizer::dual_quaternion, Minimizer::orthonormal};
constexpr Minimizer steps[] = {Minimizer::helix, Minimizer::small_angle, Minimizer::lu_milios};

/// The motion that a minimizer comes to when its pairs stay the same.
Pose settled(std::vector<Pair> pairs, Minimizer minimizer) {
  Pose motion = Pose::Identity();
  for (int i = 0; i < 200; ++i) {
    const Pose step = rigid_motion(pairs, minimizer);
    for (Pair& pair : pairs) pair.source = step * pair.source;
    motion = orthonormalized(step * motion);
  }
  return motion;
}

double squared_distances(const std::vector<Pair>& pairs, const Pose& motion) {
  double sum = 0;
  for (const Pair& pair : pairs)
    sum += pair.weight * (motion * pair.source - pair.target).squaredNorm();
  return sum;
}

/// Pairs with errors and weights, far from the origin.
std::vector<Pair> noisy_pairs(std::mt19937& random, double turn) {
  auto pairs =
      moved_pairs(random_points(random, {2, 3, 1}), testing::random_motion(random, 2, turn));
  std::normal_distribution<double> noise(0, 0.1);
  std::uniform_real_distribution<double> weight(0.1, 2);
  for (Pair& pair : pairs) {
    pair.source += Eigen::Vector3d(200, -100, 30);
    pair.target += Eigen::Vector3d(noise(random), noise(random), noise(random));
    pair.weight = weight(random);
  }
  return pairs;
}

TEST(RigidMotion, RecoversAnyMotionAtOnce) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose motion = testing::random_motion(random, 5, 3.1);
    const auto pairs = moved_pairs(random_points(random, {1, 2, 3}), motion);
    for (const Minimizer minimizer : closed_forms)
      EXPECT_TRUE(rigid_motion(pairs, minimizer).isApprox(motion, 1e-9)) << int(minimizer);
  }
}

TEST(RigidMotion, IsTheSameByEveryMinimizer) {
  std::mt19937 random(5);
  for (int i = 0; i < 50; ++i) {
    const auto pairs = noisy_pairs(random, 0.9);
    const Pose expected = rigid_motion(pairs, Minimizer::svd);
    for (const Minimizer minimizer : closed_forms)
      EXPECT_TRUE(rigid_motion(pairs, minimizer).isApprox(expected, 1e-9)) << int(minimizer);
    for (const Minimizer minimizer : {Minimizer::helix, Minimizer::small_angle})
      EXPECT_TRUE(settled(pairs, minimizer).isApprox(expected, 1e-7)) << int(minimizer);
  }
}

TEST(RigidMotion, OfLuMiliosIsExactWithoutErrorsAndNearThemWithSmallOnes) {
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    const Pose motion = testing::random_motion(random, 2, 1.5);
    const auto exact = moved_pairs(random_points(random, {1, 2, 3}), motion);
    EXPECT_TRUE(rigid_motion(exact, Minimizer::lu_milios).isApprox(motion, 1e-9));
    const auto pairs = noisy_pairs(random, 0.9);
    // Midpoints hold half of the errors, so its minimum is another one, hardly worse.
    EXPECT_LT(squared_distances(pairs, settled(pairs, Minimizer::lu_milios)),
              1.01 * squared_distances(pairs, rigid_motion(pairs)));
  }
}

TEST(RigidMotion, HasTheLeastSquares) {
  std::mt19937 random(7);
  for (int i = 0; i < 20; ++i) {
    const auto pairs = noisy_pairs(random, 3);
    const Pose best = rigid_motion(pairs);
    const Eigen::Vector3d centre(200, -100, 30);
    for (int k = 0; k < 30; ++k) {
      const Pose nudge = testing::random_motion(random, 0.02, 0.01);
      const Pose there(Eigen::Translation3d(best * centre));
      EXPECT_GE(squared_distances(pairs, there * nudge * there.inverse() * best),
                squared_distances(pairs, best));
    }
  }
}

TEST(RigidMotion, IsARotationForPointsOfAPlaneToo) {
  std::mt19937 random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose motion = testing::random_motion(random, 1, 3.1);
    const auto pairs = moved_pairs(random_points(random, {1, 2, 0}), motion);
    for (const Minimizer minimizer : closed_forms) {
      const Pose found = rigid_motion(pairs, minimizer);
      EXPECT_NEAR(found.linear().determinant(), 1, 1e-12);
      EXPECT_TRUE(found.isApprox(motion, 1e-7)) << int(minimizer);
    }
  }
}

TEST(RigidMotion, NeverMirrors) {
  std::mt19937 random(3);
  std::vector<Pair> pairs;
  for (const Eigen::Vector3d& p : random_points(random, {1, 2, 3}))
    pairs.push_back({.source = p,
                     .target = Eigen::Vector3d(p.x(), p.y(), -p.z()),
                     .normal = Eigen::Vector3d::Zero()});
  const Pose expected = rigid_motion(pairs);
  for (const Minimizer minimizer : closed_forms) {
    const Pose found = rigid_motion(pairs, minimizer);
    EXPECT_NEAR(found.linear().determinant(), 1, 1e-12);
    EXPECT_TRUE(found.isApprox(expected, 1e-8)) << int(minimizer);
  }
  for (const Minimizer minimizer : steps)
    EXPECT_NEAR(settled(pairs, minimizer).linear().determinant(), 1, 1e-9);
}

TEST(RigidMotion, MinimizesForPointsOfALine) {
  std::mt19937 random(4);
  const auto pairs =
      moved_pairs(random_points(random, {1, 0, 0}), testing::random_motion(random, 1, 1));
  for (const Minimizer minimizer : closed_forms) {
    const Pose found = rigid_motion(pairs, minimizer);
    EXPECT_NEAR(found.linear().determinant(), 1, 1e-12);
    EXPECT_LT(squared_distances(pairs, found), 1e-12) << int(minimizer);
  }
  for (const Minimizer minimizer : steps)
    EXPECT_LT(squared_distances(pairs, settled(pairs, minimizer)), 1e-12) << int(minimizer);
}

TEST(RigidMotion, StaysWithoutPairs) {
  for (const Minimizer minimizer : closed_forms)
    EXPECT_TRUE(rigid_motion({}, minimizer).isApprox(Pose::Identity()));
  for (const Minimizer minimizer : steps)
    EXPECT_TRUE(rigid_motion({}, minimizer).isApprox(Pose::Identity()));
}

TEST(RigidMotion, IsAShiftForOnePairOrOnePlace) {
  const std::vector<Pair> pairs(3, {.source = {1, 2, 3}, .target = {1, 2, 4}, .normal = {0, 0, 0}});
  for (const Minimizer minimizer : steps) {
    const Pose found = rigid_motion(pairs, minimizer);
    EXPECT_TRUE(found.isApprox(Pose(Eigen::Translation3d(0, 0, 1)), 1e-12)) << int(minimizer);
  }
  for (const Minimizer minimizer : closed_forms)
    EXPECT_LT(squared_distances(pairs, rigid_motion(pairs, minimizer)), 1e-20) << int(minimizer);
}

}  // namespace
}  // namespace planum
