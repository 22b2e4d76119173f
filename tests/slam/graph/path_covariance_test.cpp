#include "slam/graph/path_covariance.hpp"

#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

Matrix6d diagonal(double translation, double rotation) {
  return both_parts(translation, rotation).asDiagonal();
}

TEST(PathCovariance, AgreesWithSampledErrors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  PoseGraph graph;
  graph.poses.resize(3, Pose::Identity());
  const Matrix6d covariance = diagonal(1e-6, 4e-6);
  // The second edge is given the other way round.
  graph.edges = {{.from = 0,
                  .to = 1,
                  .from_from_to = testing::random_motion(random, 3, 1),
                  .information = covariance.inverse()},
                 {.from = 2,
                  .to = 1,
                  .from_from_to = testing::random_motion(random, 4, 1),
                  .information = covariance.inverse()}};
  const Pose &a = graph.edges[0].from_from_to, &b = graph.edges[1].from_from_to;
  const auto found = PathCovariances(graph, Matrix6d::Zero()).from(0);
  ASSERT_TRUE(found[2]);
  EXPECT_TRUE(found[0]->isZero());
  EXPECT_TRUE(found[1]->isApprox(covariance, 1e-9));
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    const auto error = [&] {
      Vector6d e;
      for (int i = 0; i < 6; ++i) e[i] = std::sqrt(covariance(i, i)) * normal(random);
      return exp_se3(e);
    };
    const Pose noisy = a * error() * (b * error()).inverse();
    const Vector6d e = log_se3((a * b.inverse()).inverse() * noisy);
    sampled += e * e.transpose() / samples;
  }
  EXPECT_LT((sampled - *found[2]).norm(), 0.05 * found[2]->norm());
}

TEST(PathCovariance, TakesTheBestPathAndAddsTheNoiseOfSteps) {
  PoseGraph graph;
  graph.poses.resize(4, Pose::Identity());
  graph.edges = {{.from = 0, .to = 1, .information = diagonal(100, 100)},
                 {.from = 1, .to = 2, .information = diagonal(100, 100)},
                 {.from = 0, .to = 2, .information = diagonal(10, 10)},
                 {.from = 0, .to = 2, .information = diagonal(1e9, 1e9), .accepted = false}};
  const auto found = PathCovariances(graph, diagonal(0.001, 0.001)).from(0);
  EXPECT_NEAR((*found[2])(0, 0), 0.02 + 0.002, 1e-12);
  EXPECT_FALSE(found[3]) << "nothing leads there";
}

TEST(PathCovariance, GoesNotAlongEdgesThatLeaveADirectionOpen) {
  PoseGraph graph;
  graph.poses.resize(2, Pose::Identity());
  graph.edges = {{.from = 0, .to = 1, .information = diagonal(100, 0)}};
  EXPECT_FALSE(PathCovariances(graph, Matrix6d::Zero()).from(0)[1]);
}

}  // namespace
}  // namespace planum
