#include "slam/evaluation/relations.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/trajectory_error.hpp"

namespace planum {
namespace {

Trajectory random_walk(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Trajectory walk;
  Pose pose = Pose::Identity();
  for (int i = 0; i < count; ++i) {
    walk.push_back({1.0 * i, pose});
    Vector6d step;
    for (double& value : step) value = 0.3 * normal(random);
    pose = pose * exp_se3(step);
  }
  return walk;
}

TEST(Relations, AreOfPosesInARowOrOfAllThatAreNear) {
  const Trajectory truth = random_walk(30, 1);
  const std::vector<Relation> steps = relations_of(truth);
  ASSERT_EQ(steps.size(), 29u);
  EXPECT_EQ(steps[4].from, 4);
  EXPECT_EQ(steps[4].to, 5);
  const std::vector<Relation> near = relations_of(truth, {.max_distance = 1.5});
  std::size_t expected = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t j = i + 1; j < truth.size(); ++j)
      if ((truth[i].pose.translation() - truth[j].pose.translation()).norm() <= 1.5) ++expected;
  EXPECT_EQ(near.size(), expected);
  EXPECT_EQ(relations_of(truth, {.max_distance = 1.5, .max_count = 7}).size(), 7u);
  EXPECT_TRUE(relations_of({}).empty());
}

TEST(RelationError, IsZeroForTheTruthInAnyFrame) {
  const Trajectory truth = random_walk(20, 2);
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.pose = pose_from_xyz_ypr({4, 5, 6}, 1, 2, 3) * pose.pose;
  const RelationError error = relation_error(estimate, relations_of(truth, {.max_distance = 100}));
  EXPECT_EQ(error.translation.count, 190u);
  EXPECT_LT(error.translation.max, 1e-9);
  EXPECT_LT(error.rotation.max, 1e-5);
}

TEST(RelationError, OfStepsIsTheRelativePoseError) {
  const Trajectory truth = random_walk(20, 3);
  Trajectory estimate = random_walk(20, 4);
  const RelationError error = relation_error(estimate, relations_of(truth));
  const TrajectoryError relative = trajectory_error(estimate, truth);
  EXPECT_NEAR(error.translation.mean, relative.rpe_translation.mean, 1e-9);
  EXPECT_NEAR(error.rotation.max, relative.rpe_rotation.max, 1e-6);
  EXPECT_NEAR(error.squared_translation.mean, std::pow(relative.rpe_translation.rmse, 2), 1e-9);
}

/// The point of relations: one wrong turn is one wrong relation, not a wrong world.
TEST(RelationError, CountsAnErrorOnceWhereItHappens) {
  const Trajectory truth = random_walk(40, 5);
  Trajectory estimate = truth;
  const Pose before = truth[20].pose;
  const Pose bend = before * pose_from_xyz_ypr({0, 0.3, 0.4}, radians(10), 0, 0) * before.inverse();
  for (std::size_t i = 20; i < estimate.size(); ++i) estimate[i].pose = bend * truth[i].pose;
  const RelationError error = relation_error(estimate, relations_of(truth));
  EXPECT_NEAR(error.rotation.max, 10, 1e-6);
  EXPECT_NEAR(error.rotation.mean, 10.0 / 39, 1e-6);
  EXPECT_NEAR(error.squared_rotation.mean, 100.0 / 39, 1e-5);
  EXPECT_NEAR(error.squared_translation.max, 0.25, 1e-9);
  EXPECT_GT(
      trajectory_error(estimate, truth, {.alignment = TrajectoryAlignment::none}).ape_rotation.mean,
      4);
}

TEST(RelationError, CountsRelationsOfPosesThatAreNotThere) {
  const Trajectory truth = random_walk(10, 6);
  const Trajectory estimate(truth.begin() + 2, truth.end());
  const RelationError error = relation_error(estimate, relations_of(truth));
  EXPECT_EQ(error.unknown, 2u);
  EXPECT_EQ(error.translation.count, 7u);
}

TEST(RelationError, SaysWhatIsWrong) {
  const Trajectory truth = random_walk(5, 7);
  const std::vector<Relation> elsewhere = {{.from = 77, .to = 78}};
  EXPECT_THROW(relation_error(truth, elsewhere), Error);
  EXPECT_THROW(relation_error(truth, {}), Error);
  EXPECT_THROW(relation_error(truth, relations_of(truth), -1), Error);
  const std::vector<Relation> broken = {{.from = NAN, .to = 1}};
  EXPECT_THROW(relation_error(truth, broken), Error);
  EXPECT_THROW(relations_of(truth, {.max_distance = -1}), Error);
}

}  // namespace
}  // namespace planum
