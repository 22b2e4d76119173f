#include "slam/graph/pose_graph.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

TEST(PoseGraph, ErrorOfAnEdgeIsThatOfItsDefinition) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 20; ++draw) {
    const std::vector<Pose> poses = {testing::random_motion(random, 3, 1),
                                     testing::random_motion(random, 3, 1)};
    Vector6d error;
    error << 0.1, -0.2, 0.05, 0.3, 0.1, -0.2;
    const Edge edge{
        .from = 0, .to = 1, .from_from_to = poses[0].inverse() * poses[1] * exp_se3(-error)};
    EXPECT_TRUE(edge_error(edge, poses).isApprox(error, 1e-9));
  }
}

TEST(PoseGraph, IsMadeOfTheStepsOfASequence) {
  SequenceMatch sequence;
  sequence.poses.resize(3, Pose::Identity());
  sequence.steps.resize(2);
  sequence.steps[0].matched = true;
  sequence.steps[0].alignment.rms = 0.01;
  sequence.steps[1].reason = "too few pairs";
  sequence.steps[1].odometry_information.setIdentity();
  const PoseGraph graph = pose_graph(sequence);
  ASSERT_EQ(graph.edges.size(), 2u);
  EXPECT_EQ(graph.edges[1].from, 1u);
  EXPECT_EQ(graph.edges[1].to, 2u);
  EXPECT_EQ(graph.edges[0].rms, 0.01);
  EXPECT_TRUE(graph.edges[0].matched);
  EXPECT_FALSE(graph.edges[1].matched);
  EXPECT_TRUE(graph.edges[1].accepted);
  EXPECT_EQ(graph.edges[1].reason, "too few pairs");
  EXPECT_EQ(graph.edges[1].odometry_information, Matrix6d::Identity());
}

TEST(Components, AreHeldTogetherByAcceptedMatchesOnly) {
  PoseGraph graph;
  graph.poses.resize(7, Pose::Identity());
  graph.edges = {{.from = 0, .to = 1},
                 {.from = 1, .to = 2, .accepted = false},
                 {.from = 2, .to = 3, .matched = false},
                 {.from = 5, .to = 3, .kind = EdgeKind::loop},
                 {.from = 4, .to = 5}};
  const Components found = components(graph);
  EXPECT_EQ(found.count, 4u);
  EXPECT_EQ(found.of_pose, (std::vector<std::size_t>{0, 0, 1, 2, 2, 2, 3}));
  EXPECT_EQ(found.members(), (std::vector<std::vector<std::size_t>>{{0, 1}, {2}, {3, 4, 5}, {6}}));
}

TEST(Components, OfAnEmptyGraphAreNone) {
  EXPECT_EQ(components({}).count, 0u);
  EXPECT_TRUE(components({}).members().empty());
}

}  // namespace
}  // namespace planum
