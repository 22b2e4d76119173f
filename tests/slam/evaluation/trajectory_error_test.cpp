#include "slam/evaluation/trajectory_error.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

Pose at(double x, double y, double z, double yaw_deg = 0) {
  return pose_from_xyz_ypr({x, y, z}, radians(yaw_deg), 0, 0);
}

/// A square walked once round, with height, so that no rotation is open.
Trajectory walk() {
  Trajectory poses;
  for (int i = 0; i < 20; ++i) {
    const double angle = 2 * pi * i / 20;
    poses.push_back({static_cast<double>(i), at(3 * std::cos(angle), 2 * std::sin(angle),
                                                0.2 * std::sin(3 * angle), degrees(angle))});
  }
  return poses;
}

Trajectory moved(Trajectory trajectory, const Pose& world_from_old) {
  for (StampedPose& stamped : trajectory) stamped.pose = world_from_old * stamped.pose;
  return trajectory;
}

TEST(Statistics, AreThoseOfEvo) {
  const std::vector<double> errors = {1, 2, 3, 6};
  const ErrorStatistics s = statistics(errors);
  EXPECT_DOUBLE_EQ(s.mean, 3);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.min, 1);
  EXPECT_DOUBLE_EQ(s.max, 6);
  EXPECT_DOUBLE_EQ(s.sse, 50);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(3.5));
  EXPECT_EQ(s.count, 4u);
  EXPECT_EQ(statistics({}).count, 0u);
  EXPECT_EQ(statistics({}).rmse, 0);
}

TEST(TrajectoryError, IsZeroForTheSamePathInAnotherFrame) {
  const Trajectory truth = walk();
  const Trajectory estimate = moved(truth, pose_from_xyz_ypr({10, -4, 2}, 1.1, 0.2, -0.4));
  for (const auto alignment : {TrajectoryAlignment::first_pose, TrajectoryAlignment::positions,
                               TrajectoryAlignment::joint}) {
    const TrajectoryError error = trajectory_error(estimate, truth, {.alignment = alignment});
    EXPECT_LT(error.ape_translation.max, 1e-9);
    EXPECT_LT(error.ape_rotation.max, 1e-5);
    EXPECT_LT(error.rpe_translation.max, 1e-9);
    EXPECT_LT(error.rpe_rotation.max, 1e-5);
  }
}

TEST(TrajectoryError, IsTheShiftAndTurnThatWerePutIn) {
  const Trajectory truth = walk();
  Trajectory estimate = truth;
  estimate[7].pose = estimate[7].pose * at(0.3, 0, 0.4, 5);
  const TrajectoryError error =
      trajectory_error(estimate, truth, {.alignment = TrajectoryAlignment::none});
  EXPECT_NEAR(error.ape_translation.max, 0.5, 1e-12);
  EXPECT_NEAR(error.ape_translation.rmse, 0.5 / std::sqrt(20.0), 1e-12);
  EXPECT_NEAR(error.ape_rotation.max, 5, 1e-9);
  EXPECT_NEAR(error.ape_rotation.mean, 5.0 / 20, 1e-7);
  // One pose is part of two relative poses.
  EXPECT_EQ(error.rpe_translation.count, 19u);
  EXPECT_NEAR(error.rpe_rotation.mean, 10.0 / 19, 1e-7);
  EXPECT_NEAR(error.rpe_translation.min, 0, 1e-12);
}

TEST(TrajectoryError, RelativeErrorsSpanDeltaPoses) {
  const Trajectory truth = walk();
  Trajectory estimate;
  for (const StampedPose& pose : truth) {
    estimate.push_back(pose);
    estimate.back().pose.translation().x() *= 1.1;
  }
  TrajectoryErrorParams params{.alignment = TrajectoryAlignment::none, .delta = 4};
  EXPECT_EQ(trajectory_error(estimate, truth, params).rpe_translation.count, 4u);
  params.all_pairs = true;
  const TrajectoryError error = trajectory_error(estimate, truth, params);
  ASSERT_EQ(error.rpe_translation.count, 16u);
  double largest = 0;
  for (std::size_t i = 0; i + 4 < truth.size(); ++i) {
    const auto relative = [&](const Trajectory& path) {
      return path[i].pose.inverse() * path[i + 4].pose;
    };
    largest =
        std::max(largest, (relative(truth).inverse() * relative(estimate)).translation().norm());
  }
  EXPECT_NEAR(error.rpe_translation.max, largest, 1e-12);
}

TEST(TrajectoryError, FallsBackToJointAlignmentOnALine) {
  Trajectory truth, estimate;
  for (int i = 0; i < 6; ++i) {
    truth.push_back({static_cast<double>(i), at(i, 0, 0)});
    estimate.push_back({static_cast<double>(i), at(0, i, 0, 90)});
  }
  const TrajectoryError error = trajectory_error(estimate, truth);
  EXPECT_EQ(error.alignment, TrajectoryAlignment::joint);
  EXPECT_LT(error.ape_translation.max, 1e-9);
  EXPECT_LT(error.ape_rotation.max, 1e-5);
}

TEST(Associated, TakesTheNearestStampsWithinTheLimit) {
  Trajectory estimate, truth;
  for (const double stamp : {0.0, 1.004, 2.0, 9.0}) estimate.push_back({stamp, at(stamp, 0, 0)});
  for (const double stamp : {0.001, 0.5, 1.0, 1.009, 2.2, 3.0, 4.0})
    truth.push_back({stamp, at(stamp, 0, 0)});
  const std::vector<std::pair<std::size_t, std::size_t>> expected = {{0, 0}, {1, 2}};
  EXPECT_EQ(associated(estimate, truth, 0.01), expected);
}

TEST(TrajectoryError, SaysWhatIsWrong) {
  Trajectory late = walk();
  for (StampedPose& pose : late) pose.stamp += 1000;
  EXPECT_THROW(trajectory_error(late, walk()), Error);
  EXPECT_THROW(trajectory_error({}, walk()), Error);
  EXPECT_THROW(trajectory_error(walk(), walk(), {.delta = 0}), Error);
  Trajectory broken = walk();
  broken[3].pose.translation().x() = NAN;
  EXPECT_THROW(trajectory_error(broken, walk()), Error);
}

}  // namespace
}  // namespace planum
