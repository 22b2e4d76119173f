#include "slam/registration/normal_equations.hpp"

#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

std::vector<Pair> random_pairs(std::mt19937& random, std::size_t count) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> weight(0.1, 1);
  const auto vector = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random));
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p = 3 * vector() + Eigen::Vector3d(5, -3, 1);
    const Eigen::Vector3d n = vector().normalized();
    pairs.push_back({.source = p,
                     .target = p + 0.02 * vector(),
                     .normal = n,
                     .weight = weight(random),
                     .source_normal = (n + 0.05 * vector()).normalized()});
  }
  return pairs;
}

/// What the equations stand for, with the sources moved (for symmetric, half of it on either side).
double cost(const std::vector<Pair>& pairs, Pairing pairing, const Eigen::Vector3d& centre,
            const Vector6d& twist) {
  const Pose whole = motion_about(centre, twist), half = motion_about(centre, 0.5 * twist);
  double sum = 0;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d gap = whole * pair.source - pair.target;
    double squared = gap.squaredNorm();
    if (pairing == Pairing::point_to_plane) squared = std::pow(pair.normal.dot(gap), 2);
    if (pairing == Pairing::plane_to_plane) squared = gap.dot(pair_metric(pair) * gap);
    if (pairing == Pairing::symmetric)
      squared = std::pow(pair.normal.dot(half * pair.source - half.inverse() * pair.target), 2);
    sum += pair.weight * squared;
  }
  return sum;
}

class NormalEquationsOf : public ::testing::TestWithParam<Pairing> {};

TEST_P(NormalEquationsOf, HaveTheDerivativesOfSmallMotions) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 5; ++draw) {
    const std::vector<Pair> pairs = random_pairs(random, 40);
    const NormalEquations equations = normal_equations(pairs, GetParam());
    EXPECT_NEAR(equations.squared_residuals,
                cost(pairs, GetParam(), equations.centre, Vector6d::Zero()), 1e-12);
    const auto moved_cost = [&](const Vector6d& twist) {
      return cost(pairs, GetParam(), equations.centre, twist);
    };
    constexpr double h = 1e-5;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = h * Vector6d::Unit(i);
      // The cost is c + 2 g.x + x'Hx + ...
      EXPECT_NEAR((moved_cost(step) - moved_cost(-step)) / (4 * h), equations.gradient[i], 1e-6);
    }
  }
}

TEST_P(NormalEquationsOf, SolveForASmallMotion) {
  std::mt19937 random(2);
  for (int draw = 0; draw < 10; ++draw) {
    std::vector<Pair> pairs = random_pairs(random, 60);
    for (Pair& pair : pairs) pair.target = pair.source;
    const Pose motion = testing::random_motion(random, 1e-4, 1e-4);
    for (Pair& pair : pairs) pair.target = motion * pair.source;
    const NormalEquations equations = normal_equations(pairs, GetParam());
    const Determined system = determined(equations);
    EXPECT_EQ(system.weak_directions, 0);
    const Pose found = motion_about(equations.centre, system.solution);
    EXPECT_LT(testing::shift_between(found, motion), 1e-6);
    EXPECT_LT(rotation_angle(found, motion), 1e-6);
  }
}

TEST_P(NormalEquationsOf, AreEmptyWithoutPairs) {
  const Determined system = determined(normal_equations({}, GetParam()));
  EXPECT_EQ(system.weak_directions, 6);
  EXPECT_TRUE(system.solution.isZero());
  EXPECT_TRUE(system.hessian.isZero());
}

INSTANTIATE_TEST_SUITE_P(Registration, NormalEquationsOf,
                         ::testing::Values(Pairing::point_to_point, Pairing::point_to_plane,
                                           Pairing::plane_to_plane, Pairing::symmetric));

TEST(PairMetric, IsAlongTheNormalWhereBothAgree) {
  std::mt19937 random(9);
  for (Pair& pair : random_pairs(random, 20)) {
    pair.source_normal = pair.normal;
    const Eigen::Matrix3d metric = pair_metric(pair);
    EXPECT_NEAR(pair.normal.dot(metric * pair.normal), 1, 1e-9);
    const Eigen::Vector3d along = pair.normal.unitOrthogonal();
    EXPECT_NEAR(along.dot(metric * along), 1e-3, 1e-9);
  }
}

/// Pairs all over the planes given by their normals, one metre from the origin.
std::vector<Pair> pairs_of_planes(const std::vector<Eigen::Vector3d>& normals, double gap) {
  std::vector<Pair> pairs;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-2, 2);
  for (const Eigen::Vector3d& n : normals) {
    const Eigen::Vector3d u = n.unitOrthogonal(), v = n.cross(u);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d q = n + along(random) * u + along(random) * v;
      pairs.push_back({.source = q + gap * n, .target = q, .normal = n});
    }
  }
  return pairs;
}

TEST(Determined, LeavesThreeDirectionsOfASinglePlane) {
  const auto equations =
      point_to_plane_equations(pairs_of_planes({Eigen::Vector3d(1, 2, 3).normalized()}, 0.01));
  const Determined system = determined(equations);
  EXPECT_EQ(system.weak_directions, 3);
  const Pose motion = motion_about(equations.centre, system.solution);
  const Eigen::Vector3d shift = motion * equations.centre - equations.centre;
  EXPECT_TRUE(shift.isApprox(-0.01 * Eigen::Vector3d(1, 2, 3).normalized(), 1e-6));
  EXPECT_LT(rotation_angle(motion), 1e-9);
}

TEST(Determined, LeavesTheDirectionAlongACorridor) {
  const Determined system = determined(point_to_plane_equations(
      pairs_of_planes({{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, 0.01)));
  EXPECT_EQ(system.weak_directions, 1);
  EXPECT_NEAR(system.hessian(0, 0), 0, 1e-9);
  EXPECT_NEAR(system.solution[0], 0, 1e-12);
}

TEST(Determined, LeavesNothingOfARoom) {
  EXPECT_EQ(determined(point_to_plane_equations(pairs_of_planes(
                           {{1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, 0.01)))
                .weak_directions,
            0);
}

TEST(TwistAbout, MovesPointsTheSameWay) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 20; ++draw) {
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = 1e-6 * normal(random);
    const Eigen::Vector3d centre(normal(random), normal(random), normal(random));
    const Eigen::Vector3d p(normal(random), normal(random), normal(random));
    const Eigen::Vector3d about_origin = motion_about(Eigen::Vector3d::Zero(), twist) * p;
    const Eigen::Vector3d about_centre = motion_about(centre, twist_about(centre) * twist) * p;
    EXPECT_LT((about_origin - about_centre).norm(), 1e-11);
  }
}

TEST(ResidualVariance, CountsTheDegreesOfFreedom) {
  NormalEquations equations;
  equations.weight = 10;
  equations.squared_residuals = 4;
  equations.pairs = 10;
  EXPECT_DOUBLE_EQ(equations.residual_variance(), 4.0 / (10 - 6));
  equations.equations_per_pair = 3;
  EXPECT_DOUBLE_EQ(equations.residual_variance(), 4.0 / (3 * 10 - 6));
  equations.pairs = 2;
  EXPECT_EQ(equations.residual_variance(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace planum
