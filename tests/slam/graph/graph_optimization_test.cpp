#include "slam/graph/graph_optimization.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/slam/graph/synthetic_graph.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::position_rms;
using testing::synthetic_graph;
using testing::SyntheticGraph;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <class Manifold>
class GraphOptimization : public ::testing::Test {};
using Manifolds = ::testing::Types<SpatialManifold, PlanarManifold>;
TYPED_TEST_SUITE(GraphOptimization, Manifolds);

/// Chi-squared: as many as error dimensions that no pose can take up, +- 5 standard deviations.
template <class Manifold>
void expect_noise_only(const typename Manifold::GraphType& graph, double cost) {
  const double freedom =
      Manifold::dimension * (static_cast<double>(graph.edges.size() - graph.poses.size()) + 1);
  EXPECT_NEAR(cost, freedom, 5 * std::sqrt(2 * freedom));
}

TYPED_TEST(GraphOptimization, LeavesOnlyTheNoise) {
  using M = TypeParam;
  const SyntheticGraph<M> made = synthetic_graph<M>(300, 150, 0, 1);
  const auto result = optimize(made.graph);
  EXPECT_TRUE(result.quality.converged);
  EXPECT_GT(result.quality.cost_before, result.quality.cost_after);
  expect_noise_only<M>(made.graph, result.quality.cost_after);
  // The true errors are as large as the covariances say: chi-squared of all dimensions a pose, but
  // not independent from pose to pose.
  double squared = 0;
  for (std::size_t i = 1; i < made.truth.size(); ++i) {
    const typename M::Vector off =
        M::error(result.poses[i], made.truth[i], M::identity(), RotationError::angle);
    squared += off.dot(result.covariances[i].llt().solve(off));
  }
  const double mean = squared / (M::dimension * static_cast<double>(made.truth.size() - 1));
  EXPECT_GT(mean, 0.2);
  EXPECT_LT(mean, 3.0);
  EXPECT_LT(position_rms<M>(result.poses, made.truth),
            0.3 * position_rms<M>(made.graph.poses, made.truth));
  EXPECT_EQ(M::position(result.poses[0]), M::position(made.graph.poses[0]));
}

TYPED_TEST(GraphOptimization, DoesNotMindBadOrMissingPoses) {
  using M = TypeParam;
  const SyntheticGraph<M> made = synthetic_graph<M>(200, 100, 0, 2);
  const auto good = optimize(made.graph);
  std::mt19937 random(1);
  auto graph = made.graph;
  for (std::size_t i = 1; i < graph.poses.size(); ++i)
    graph.poses[i] = M::moved(graph.poses[i], 5 * testing::normal_vector<M::dimension>(random));
  const auto from_bad = optimize(graph);
  for (std::size_t i = 1; i < graph.poses.size(); i += 3)
    graph.poses[i] = M::pose(M::rotation(graph.poses[i]), M::Position::Constant(not_a_number));
  const auto from_some = optimize(graph);
  EXPECT_TRUE(std::isinf(from_some.quality.cost_before));
  for (auto& pose : graph.poses)
    pose = M::pose(M::Rotation::Identity(), M::Position::Constant(not_a_number));
  const auto from_none = optimize(graph);
  for (const auto* result : {&from_bad, &from_some, &from_none}) {
    EXPECT_TRUE(result->quality.converged);
    EXPECT_NEAR(result->quality.cost_after / good.quality.cost_after, 1, 1e-7);
  }
  EXPECT_LT(position_rms<M>(from_some.poses, good.poses), 1e-4);
  for (const auto& pose : from_none.poses) EXPECT_TRUE(M::finite(pose));
}

TYPED_TEST(GraphOptimization, MovesWithTheWorld) {
  using M = TypeParam;
  const SyntheticGraph<M> made = synthetic_graph<M>(150, 80, 0.1, 3);
  auto moved = made.graph;
  const auto motion = M::moved(M::identity(), 50 * M::Vector::Ones() / M::dimension);
  for (auto& pose : moved.poses) pose = M::product(motion, pose);
  const auto here = optimize(made.graph), there = optimize(moved);
  EXPECT_EQ(here.quality.counts, there.quality.counts);
  for (std::size_t i = 0; i < moved.poses.size(); ++i)
    EXPECT_LT((M::position(M::product(motion, here.poses[i])) - M::position(there.poses[i])).norm(),
              1e-5);
}

TYPED_TEST(GraphOptimization, IsTheSameForAnyNumberOfThreads) {
  using M = TypeParam;
  const SyntheticGraph<M> made = synthetic_graph<M>(200, 80, 0.2, 4);
  std::vector<std::vector<double>> bits;
  for (const int threads : {1, 2, 5}) {
    const testing::ThreadCount count(threads);
    const auto result = optimize(made.graph);
    auto& values = bits.emplace_back();
    for (std::size_t i = 0; i < result.poses.size(); ++i) {
      for (const double v : M::position(result.poses[i])) values.push_back(v);
      const typename M::Rotation rotation = M::rotation(result.poses[i]);
      for (const double v : rotation.reshaped()) values.push_back(v);
      for (const double v : result.covariances[i].reshaped()) values.push_back(v);
    }
  }
  EXPECT_EQ(bits[0], bits[1]);
  EXPECT_EQ(bits[0], bits[2]);
}

TYPED_TEST(GraphOptimization, CovariancesAreThoseOfADenseInverse) {
  using M = TypeParam;
  constexpr int n = M::dimension;
  const SyntheticGraph<M> made = synthetic_graph<M>(40, 20, 0, 5);
  const auto result = optimize(made.graph, {.fixed = {7}});
  const auto count = static_cast<Eigen::Index>(result.poses.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n * count, n * count);
  for (const auto& edge : made.graph.edges) {
    const auto l = M::linearized(result.poses[edge.from], result.poses[edge.to], edge.from_from_to,
                                 M::space == 3 ? RotationError::chord : RotationError::angle);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(n, n * count);
    jacobian.middleCols<n>(n * static_cast<Eigen::Index>(edge.from)) = l.by_from;
    jacobian.middleCols<n>(n * static_cast<Eigen::Index>(edge.to)) = l.by_to;
    hessian += jacobian.transpose() * edge.information * jacobian;
  }
  hessian.middleRows<n>(n * 7).setZero();
  hessian.middleCols<n>(n * 7).setZero();
  hessian.block<n, n>(n * 7, n * 7).setIdentity();
  const Eigen::MatrixXd inverse = hessian.inverse();
  ASSERT_EQ(result.covariances.size(), result.poses.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const typename M::Matrix& found = result.covariances[static_cast<std::size_t>(i)];
    if (i == 7)
      EXPECT_EQ(found.norm(), 0);
    else
      EXPECT_LT((found - inverse.block<n, n>(n * i, n * i)).norm(), 1e-8 * found.norm());
  }
}

TYPED_TEST(GraphOptimization, KeepsFixedPoses) {
  using M = TypeParam;
  SyntheticGraph<M> made = synthetic_graph<M>(100, 50, 0.2, 6);
  const std::vector<std::size_t> fixed = {20, 70};
  for (const std::size_t pose : fixed) made.graph.poses[pose] = made.truth[pose];
  for (const LoopRejection rejection : {LoopRejection::if_needed, LoopRejection::always}) {
    const auto result = optimize(made.graph, {.rejection = rejection, .fixed = fixed});
    for (const std::size_t pose : fixed)
      EXPECT_LT((M::position(result.poses[pose]) - M::position(made.truth[pose])).norm(), 1e-12);
    EXPECT_LT(position_rms<M>(result.poses, made.truth), 0.5);
  }
}

TYPED_TEST(GraphOptimization, TakesEachPartByItself) {
  using M = TypeParam;
  const SyntheticGraph<M> one = synthetic_graph<M>(60, 30, 0, 7);
  const SyntheticGraph<M> other = synthetic_graph<M>(40, 20, 0, 8);
  auto both = one.graph;
  const auto motion = M::moved(M::identity(), 9 * M::Vector::Ones());
  for (const auto& pose : other.graph.poses) both.poses.push_back(M::product(motion, pose));
  for (auto edge : other.graph.edges) {
    edge.from += 60;
    edge.to += 60;
    both.edges.push_back(edge);
  }
  both.poses.push_back(motion);  // nothing is known about this one
  const auto result = optimize(both);
  EXPECT_TRUE(result.quality.converged);
  ASSERT_EQ(result.quality.components.size(), 3u);
  EXPECT_EQ(result.quality.components[1].front(), 60u);
  EXPECT_EQ(result.quality.components[2], std::vector<std::size_t>{100});
  EXPECT_EQ(result.covariances.size(), 101u);
  const auto alone = optimize(one.graph), other_alone = optimize(other.graph);
  for (std::size_t i = 0; i < 60; ++i)
    EXPECT_LT((M::position(result.poses[i]) - M::position(alone.poses[i])).norm(), 1e-5);
  for (std::size_t i = 0; i < 40; ++i)
    EXPECT_LT(
        (M::position(result.poses[60 + i]) - M::position(M::product(motion, other_alone.poses[i])))
            .norm(),
        1e-5);
  EXPECT_EQ(M::position(result.poses[100]), M::position(motion));
}

TYPED_TEST(GraphOptimization, RepairsAndNamesIndefiniteInformation) {
  using M = TypeParam;
  SyntheticGraph<M> made = synthetic_graph<M>(80, 40, 0, 9);
  auto& information = made.graph.edges[33].information;
  const typename M::Matrix before = information;
  information(1, 1) = -information(1, 1);
  made.graph.edges[50].information.setZero();  // says nothing, which is no fault
  const auto result = optimize(made.graph);
  ASSERT_EQ(result.quality.repaired.size(), 1u);
  EXPECT_EQ(result.quality.repaired[0].edge, 33u);
  EXPECT_LT(result.quality.repaired[0].least_eigenvalue, -0.1 * before(1, 1));
  EXPECT_TRUE(std::isfinite(result.quality.cost_after));
  EXPECT_LT(position_rms<M>(result.poses, made.truth), 0.5);
}

TYPED_TEST(GraphOptimization, NothingIsNotANumberWhereEdgesSayNothing) {
  using M = TypeParam;
  SyntheticGraph<M> made = synthetic_graph<M>(30, 5, 0, 10);
  for (auto& edge : made.graph.edges) edge.information.setZero();
  const auto result = optimize(made.graph);
  for (const auto& pose : result.poses) EXPECT_TRUE(M::finite(pose));
  EXPECT_EQ(result.quality.cost_after, 0);
  EXPECT_TRUE(result.covariances.empty()) << "the edges do not determine the poses";
}

TYPED_TEST(GraphOptimization, RefusesBadGraphs) {
  using M = TypeParam;
  const auto good = synthetic_graph<M>(12, 0, 0, 11).graph;
  const auto message = [](auto graph, const auto& change, const GraphParams& params = {}) {
    change(graph);
    return message_of([&] { optimize(graph, params); });
  };
  EXPECT_EQ(message(good, [](auto& g) { g.edges[2].to = 99; }),
            "pose graph: edge 2 joins poses 2 and 99, but there are 12 poses");
  EXPECT_EQ(message(good, [](auto& g) { g.edges[2].to = 2; }),
            "pose graph: edge 2 joins pose 2 with itself");
  EXPECT_EQ(message(good, [](auto& g) { g.edges[4].information(1, 1) = not_a_number; }),
            "pose graph: edge 4 from pose 4 to pose 5 is not finite");
  EXPECT_EQ(message(good, [](auto&) {}, {.fixed = {12}}),
            "pose graph: pose 12 is to stay fixed, but there are 12 poses");
  EXPECT_EQ(message(good, [](auto&) {}, {.max_iterations = -1}),
            "pose graph: max_iterations must be at least 0, got -1");
  EXPECT_TRUE(optimize(typename M::GraphType{}).poses.empty());
}

TEST(GraphOptimizationInSpace, TurnsUpTowardsWhereGravityHasIt) {
  const SyntheticGraph<SpatialManifold> made = synthetic_graph<SpatialManifold>(120, 60, 0, 12);
  GraphParams params;
  std::mt19937 random(5);
  for (std::size_t i = 0; i < made.truth.size(); i += 4)
    params.gravity.push_back(
        {.pose = i,
         .up_in_pose = 9.81 * (made.truth[i].linear().transpose() * Eigen::Vector3d::UnitZ()),
         .sigma = radians(0.1)});
  const Pose tilted = pose_from_xyz_ypr({5, 4, 3}, 0.4, 0.7, -1.1);
  PoseGraph graph = made.graph;
  for (Pose& pose : graph.poses) pose = tilted * pose;
  const OptimizedGraph result = optimize(graph, params);
  EXPECT_TRUE(result.quality.converged);
  double worst = 0;
  for (std::size_t i = 0; i < made.truth.size(); ++i) {
    const Eigen::Vector3d up = made.truth[i].linear().transpose() * Eigen::Vector3d::UnitZ();
    worst = std::max(worst, (result.poses[i].linear() * up - Eigen::Vector3d::UnitZ()).norm());
  }
  EXPECT_LT(worst, radians(1.5)) << "three poses of four saw nothing";
  EXPECT_LT((result.poses[0].translation() - graph.poses[0].translation()).norm(), 1e-9);
  // The first pose may tilt, but neither move nor turn about up.
  const Matrix6d& covariance = result.covariances[0];
  const Eigen::Vector3d up = result.poses[0].linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_EQ((covariance.topLeftCorner<3, 3>().norm()), 0);
  EXPECT_LT((covariance.bottomRightCorner<3, 3>() * up).norm(), 1e-12);
  EXPECT_GT((covariance.bottomRightCorner<3, 3>().norm()), 1e-9);
}

}  // namespace
}  // namespace planum
