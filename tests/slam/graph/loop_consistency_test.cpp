#include "slam/graph/loop_consistency.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::random_motion;

constexpr std::size_t poses = 30;

/// A path there and back, its steps known to 2 cm and 0.5 deg, with the noise that goes with it.
struct Path {
  std::vector<Pose> truth;
  PoseGraph graph;
};

Matrix6d information(double translation, double rotation) {
  return both_parts(1 / (translation * translation), 1 / (rotation * rotation)).asDiagonal();
}

Pose noise(std::mt19937& random, double translation, double rotation) {
  std::normal_distribution<double> normal;
  Vector6d twist;
  for (double& x : twist) x = normal(random);
  twist.head<3>() *= translation;
  twist.tail<3>() *= rotation;
  return exp_se3(twist);
}

Path path_there_and_back(std::mt19937& random) {
  Path path;
  const double step = 0.02, turn = radians(0.5);
  for (std::size_t i = 0; i < poses; ++i) {
    const double along = i < poses / 2 ? static_cast<double>(i) : static_cast<double>(poses - i);
    path.truth.push_back(pose_from_xyz_ypr({along, 0, 0}, i < poses / 2 ? 0 : 3, 0, 0));
  }
  path.graph.poses.push_back(path.truth.front());
  for (std::size_t i = 1; i < poses; ++i) {
    const Pose measured = path.truth[i - 1].inverse() * path.truth[i] * noise(random, step, turn);
    path.graph.poses.push_back(path.graph.poses.back() * measured);
    path.graph.edges.push_back(
        {.from = i - 1, .to = i, .from_from_to = measured, .information = information(step, turn)});
  }
  return path;
}

Edge loop(const Path& path, std::size_t from, const Pose& error) {
  const std::size_t to = poses - 1 - from;
  return {.from = from,
          .to = to,
          .from_from_to = path.truth[from].inverse() * path.truth[to] * error,
          .information = information(0.01, radians(0.2)),
          .kind = EdgeKind::loop};
}

std::vector<bool> consistent(const Path& path, const std::vector<Edge>& loops) {
  std::vector<Matrix6d> covariances;
  for (const Edge& edge : loops) covariances.push_back(edge.information.inverse());
  return consistent_loops(path.graph, loops, covariances, 1e-6 * Matrix6d::Identity(), 5);
}

TEST(LoopConsistency, KeepsAllRightLoops) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Path path = path_there_and_back(random);
    std::vector<Edge> loops;
    for (std::size_t from = 0; from < 12; ++from)
      loops.push_back(loop(path, from, noise(random, 0.01, radians(0.2))));
    const std::vector<bool> kept = consistent(path, loops);
    EXPECT_EQ(std::count(kept.begin(), kept.end(), true), 12) << "seed " << seed;
  }
}

TEST(LoopConsistency, DropsLoopsThatContradictTheOthers) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const Path path = path_there_and_back(random);
    std::vector<Edge> loops;
    std::vector<bool> right;
    for (std::size_t from = 0; from < 12; ++from) {
      const bool false_one = from % 3 == 1;  // a third, each off its own way
      const Pose error = false_one ? random_motion(random, 2, 0.3) : Pose::Identity();
      loops.push_back(loop(path, from, error * noise(random, 0.01, radians(0.2))));
      right.push_back(!false_one);
    }
    EXPECT_EQ(consistent(path, loops), right) << "seed " << seed;
  }
}

TEST(LoopConsistency, DoesNotDependOnTheOrderOfTheLoops) {
  std::mt19937 random(7);
  const Path path = path_there_and_back(random);
  std::vector<Edge> loops;
  for (std::size_t from = 0; from < 12; ++from)
    loops.push_back(
        loop(path, from,
             from % 4 == 1 ? random_motion(random, 2, 0.3) : noise(random, 0.01, radians(0.2))));
  const std::vector<bool> kept = consistent(path, loops);
  std::vector<Edge> reversed(loops.rbegin(), loops.rend());
  std::vector<bool> again = consistent(path, reversed);
  std::reverse(again.begin(), again.end());
  EXPECT_EQ(kept, again);
}

TEST(LoopConsistency, LoopsOfPartsThatNothingJoinsDoNotContradict) {
  std::mt19937 random(7);
  Path path = path_there_and_back(random);
  path.graph.edges.clear();
  const std::vector<Edge> loops = {loop(path, 0, Pose::Identity()),
                                   loop(path, 5, random_motion(random, 2, 0.3))};
  EXPECT_EQ(consistent(path, loops), (std::vector<bool>{true, true}));
  EXPECT_TRUE(consistent(path, {}).empty());
}

}  // namespace
}  // namespace planum
