#include "slam/graph/elch.hpp"

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;

/// Round a square of side 10 m, with poses that turn a little too much at every step.
struct Round {
  std::vector<Pose> truth;
  PoseGraph graph;
};

Round once_round(double excess) {
  Round round;
  constexpr int steps = 40;
  Pose truth = Pose::Identity(), drifted = Pose::Identity();
  const Pose step(Eigen::Translation3d(1, 0, 0));
  for (int i = 0; i <= steps; ++i) {
    round.truth.push_back(truth);
    round.graph.poses.push_back(drifted);
    const double turn = i % 10 == 9 ? pi / 2 : 0;
    truth = truth * step * Pose(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    drifted = drifted * step * Pose(Eigen::AngleAxisd(turn + excess, Eigen::Vector3d::UnitZ()));
  }
  for (std::size_t i = 1; i < round.truth.size(); ++i)
    round.graph.edges.push_back(
        {.from = i - 1,
         .to = i,
         .from_from_to = round.graph.poses[i - 1].inverse() * round.graph.poses[i],
         .information = 1e4 * Matrix6d::Identity()});
  return round;
}

Edge loop(const Round& round, std::size_t from, std::size_t to) {
  return {.from = from,
          .to = to,
          .from_from_to = round.truth[from].inverse() * round.truth[to],
          .information = 1e6 * Matrix6d::Identity(),
          .kind = EdgeKind::loop};
}

double rmse(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    sum += (poses[i].translation() - truth[i].translation()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

TEST(Elch, ClosesTheLoopAndMovesTheWayTowardsTheTruth) {
  Round round = once_round(radians(0.5));
  round.graph.edges.push_back(loop(round, 0, 40));
  const double before = rmse(round.graph.poses, round.truth);
  const std::vector<Pose> poses = elch(round.graph);
  EXPECT_LT(edge_error(round.graph.edges.back(), poses).norm(), 1e-9);
  EXPECT_LT(rmse(poses, round.truth), before / 3);
  EXPECT_TRUE(poses[0].isApprox(round.graph.poses[0], 1e-12)) << "the loop starts where it did";
}

TEST(Elch, SharesTheErrorByUncertainty) {
  Round round = once_round(0);
  for (Edge& edge : round.graph.edges) edge.information *= 1e6;
  round.graph.edges[9].information = Matrix6d::Identity();  // all that is not sure
  Edge off = loop(round, 0, 40);
  off.from_from_to = off.from_from_to * Pose(Eigen::Translation3d(0.5, 0, 0));
  round.graph.edges.push_back(off);
  const std::vector<Pose> poses = elch(round.graph);
  const auto moved = [&](std::size_t i) {
    return (poses[i].translation() - round.graph.poses[i].translation()).norm();
  };
  EXPECT_LT(moved(9), 0.001);
  EXPECT_NEAR(moved(10), 0.5, 0.001);
}

TEST(Elch, TakesAlongWhatBranchesOff) {
  Round round = once_round(radians(0.5));
  round.graph.edges.push_back(loop(round, 10, 30));
  const std::vector<Pose> poses = elch(round.graph);
  for (const std::size_t i : {std::size_t{0}, std::size_t{5}, std::size_t{10}})
    EXPECT_TRUE(poses[i].isApprox(round.graph.poses[i], 1e-12)) << i;
  EXPECT_GT(testing::shift_between(poses[30], round.graph.poses[30]), 0.5);
  for (std::size_t i = 31; i <= 40; ++i)
    EXPECT_TRUE((poses[30].inverse() * poses[i])
                    .isApprox(round.graph.poses[30].inverse() * round.graph.poses[i], 1e-9))
        << i;
}

TEST(Elch, LeavesClosedLoopsRejectedLoopsAndOtherPartsAlone) {
  Round round = once_round(0);
  round.graph.edges.push_back(loop(round, 0, 40));
  Edge rejected = loop(round, 0, 20);
  rejected.from_from_to.translation().x() += 3;
  rejected.accepted = false;
  round.graph.edges.push_back(rejected);
  round.graph.poses.push_back(Pose(Eigen::Translation3d(50, 0, 0)));  // joined by nothing
  const std::vector<Pose> poses = elch(round.graph);
  ASSERT_EQ(poses.size(), round.graph.poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_TRUE(poses[i].isApprox(round.graph.poses[i], 1e-12)) << i;
  EXPECT_TRUE(elch({}).empty());
}

TEST(Elch, MovesWithTheWorld) {
  Round round = once_round(radians(0.5));
  round.graph.edges.push_back(loop(round, 0, 40));
  round.graph.edges.push_back(loop(round, 5, 35));
  const std::vector<Pose> here = elch(round.graph);
  const Pose moved = pose_from_xyz_ypr({100, -20, 3}, 2, 0.3, -0.4);
  for (Pose& pose : round.graph.poses) pose = moved * pose;
  const std::vector<Pose> there = elch(round.graph);
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_TRUE(there[i].isApprox(moved * here[i], 1e-9)) << i;
}

TEST(Elch, RefusesEdgesToNowhere) {
  PoseGraph graph{.poses = {Pose::Identity()}, .edges = {}};
  graph.edges.push_back({.from = 0, .to = 7});
  EXPECT_NE(message_of([&] { elch(graph); }).find("edge 0 joins poses 0 and 7"), std::string::npos);
}

}  // namespace
}  // namespace planum
