#include "slam/graph/edge_relaxation.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::random_motion;
using testing::shift_between;

/// A ring of poses with edges to the next one and some loops; measured with small errors.
PoseGraph ring(std::mt19937& random, double noise) {
  PoseGraph graph;
  constexpr std::size_t count = 12;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / count;
    graph.poses.push_back(
        pose_from_xyz_ypr({5 * std::cos(angle), 5 * std::sin(angle), 0.1 * static_cast<double>(i)},
                          angle, 0.05, -0.1));
  }
  const auto add = [&](std::size_t from, std::size_t to, EdgeKind kind) {
    const Matrix6d root = Matrix6d::Random();
    graph.edges.push_back({.from = from,
                           .to = to,
                           .from_from_to = graph.poses[from].inverse() * graph.poses[to] *
                                           random_motion(random, noise, noise),
                           .information = 100 * Matrix6d::Identity() + 20 * root * root.transpose(),
                           .kind = kind});
  };
  for (std::size_t i = 0; i + 1 < count; ++i) add(i, i + 1, EdgeKind::odometry);
  add(0, count - 1, EdgeKind::loop);
  add(2, 7, EdgeKind::loop);
  return graph;
}

std::vector<Pose> shaken(std::vector<Pose> poses, std::mt19937& random) {
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = poses[i] * random_motion(random, 0.5, 0.3);
  return poses;
}

double cost(const PoseGraph& graph, const std::vector<Pose>& poses) {
  double sum = 0;
  for (const Edge& edge : graph.edges) {
    const Vector6d e = edge_error(edge, poses);
    if (edge.accepted) sum += e.dot(edge.information * e);
  }
  return sum;
}

TEST(EdgeEquation, HasTheDerivativesOfTheError) {
  std::mt19937 random(1);
  PoseGraph graph = ring(random, 0.3);
  for (const Edge& edge : graph.edges) {
    const LinkEquation equation = edge_equation(edge, edge.information, graph.poses);
    EXPECT_EQ(equation.a, edge.to);
    EXPECT_EQ(equation.b, edge.from);
    const auto cost_after = [&](const Vector6d& a, const Vector6d& b) {
      std::vector<Pose> poses = graph.poses;
      poses[edge.to] = exp_se3(a) * poses[edge.to];
      poses[edge.from] = exp_se3(b) * poses[edge.from];
      const Vector6d e = edge_error(edge, poses);
      return e.dot(edge.information * e);
    };
    constexpr double h = 1e-5;
    for (int i = 0; i < 6; ++i) {
      const Vector6d step = h * Vector6d::Unit(i), none = Vector6d::Zero();
      const double scale = equation.information.diagonal().maxCoeff();
      // cost = c - 2 w.(X_a - X_b) + ...
      EXPECT_NEAR((cost_after(step, none) - cost_after(-step, none)) / (4 * h),
                  -equation.weighted_difference[i], 1e-6 * scale);
      EXPECT_NEAR((cost_after(none, step) - cost_after(none, -step)) / (4 * h),
                  equation.weighted_difference[i], 1e-6 * scale);
    }
  }
}

TEST(EdgeRelaxation, FindsThePosesThatTheEdgesWereMadeOf) {
  std::mt19937 random(2);
  PoseGraph graph = ring(random, 0);
  const std::vector<Pose> truth = graph.poses;
  graph.poses = shaken(truth, random);
  const EdgeRelaxation result = relax_edges(graph);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.error_before, 1);
  EXPECT_LT(result.error_after, 1e-6);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(shift_between(result.poses[i], truth[i]), 1e-5);
    EXPECT_LT(rotation_angle(result.poses[i], truth[i]), 1e-5);
  }
}

TEST(EdgeRelaxation, EndsInAMinimum) {
  std::mt19937 random(3);
  const PoseGraph graph = ring(random, 0.1);
  const EdgeRelaxation result = relax_edges(graph);
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.error_after, cost(graph, result.poses), 1e-6);
  for (int draw = 0; draw < 50; ++draw) {
    std::vector<Pose> poses = result.poses;
    for (std::size_t i = 1; i < poses.size(); ++i)
      poses[i] = random_motion(random, 1e-3, 1e-4) * poses[i];
    EXPECT_GT(cost(graph, poses), result.error_after);
  }
}

TEST(EdgeRelaxation, MovesWithTheWorld) {
  std::mt19937 random(4);
  const PoseGraph graph = ring(random, 0.1);
  PoseGraph moved = graph;
  const Pose motion = random_motion(random, 1000, 2);
  for (Pose& pose : moved.poses) pose = motion * pose;
  const EdgeRelaxation here = relax_edges(graph), there = relax_edges(moved);
  for (std::size_t i = 0; i < graph.poses.size(); ++i)
    EXPECT_LT(shift_between(motion * here.poses[i], there.poses[i]), 1e-8);
}

TEST(EdgeRelaxation, DoesNotMindTheOrderOfEdges) {
  std::mt19937 random(5);
  PoseGraph graph = ring(random, 0.1);
  const EdgeRelaxation before = relax_edges(graph);
  std::shuffle(graph.edges.begin(), graph.edges.end(), random);
  const EdgeRelaxation after = relax_edges(graph);
  for (std::size_t i = 0; i < graph.poses.size(); ++i)
    EXPECT_LT(shift_between(before.poses[i], after.poses[i]), 1e-9);
}

TEST(EdgeRelaxation, LeavesOutWhatIsNotAccepted) {
  std::mt19937 random(6);
  PoseGraph graph = ring(random, 0);
  Edge wrong = graph.edges[3];
  wrong.from_from_to = wrong.from_from_to * Pose(Eigen::Translation3d(5, 0, 0));
  wrong.accepted = false;
  graph.edges.push_back(wrong);
  EXPECT_LT(relax_edges(graph).error_after, 1e-9);
}

TEST(EdgeRelaxation, KeepsTheFirstPoseOfEveryPart) {
  std::mt19937 random(7);
  PoseGraph graph = ring(random, 0.1);
  // Without these two edges and the loops poses 0..5 and 6..11 have nothing to do with each other.
  graph.edges.erase(graph.edges.end() - 2, graph.edges.end());
  graph.edges.erase(graph.edges.begin() + 5);
  const EdgeRelaxation result = relax_edges(graph);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.poses[0].isApprox(graph.poses[0], 1e-12));
  EXPECT_TRUE(result.poses[6].isApprox(graph.poses[6], 1e-12));
  EXPECT_LT(result.error_after, 1e-9) << "a chain has no contradictions";
}

TEST(EdgeRelaxation, RefusesBadGraphs) {
  std::mt19937 random(8);
  PoseGraph graph = ring(random, 0);
  graph.edges[2].to = 99;
  EXPECT_NE(testing::message_of([&] {
              relax_edges(graph);
            }).find("edge 2 joins poses 2 and 99, but there are 12 poses"),
            std::string::npos);
  graph = ring(random, 0);
  graph.edges[4].information(1, 1) = std::nan("");
  EXPECT_NE(testing::message_of([&] {
              relax_edges(graph);
            }).find("edge 4 from pose 4 to pose 5 is not finite"),
            std::string::npos);
  graph = ring(random, 0);
  graph.poses[3].translation().x() = INFINITY;
  EXPECT_NE(testing::message_of([&] { relax_edges(graph); }).find("pose 3 is not finite"),
            std::string::npos);
  EXPECT_TRUE(relax_edges({}).poses.empty());
}

}  // namespace
}  // namespace planum
