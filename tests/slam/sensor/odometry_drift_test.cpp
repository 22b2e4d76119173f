#include "slam/sensor/odometry_drift.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

constexpr DriftParams none{.translation_per_metre = 0,
                           .height_per_metre = 0,
                           .heading_per_metre = 0,
                           .heading_per_radian = 0,
                           .heading_bias_per_metre = 0,
                           .tilt_per_stop = 0};

/// n stops, each step m ahead of the last one.
std::vector<Pose> straight(std::size_t n, double step) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < n; ++i)
    poses.push_back(pose_from_xyz_ypr({step * static_cast<double>(i), 0, 0}, 0, 0, 0));
  return poses;
}

double heading(const Pose& pose) { return std::atan2(pose(1, 0), pose(0, 0)); }

TEST(OdometryDrift, WithoutErrorsItIsTheTruth) {
  std::vector<Pose> path;
  for (int i = 0; i < 20; ++i)
    path.push_back(pose_from_xyz_ypr({std::cos(i), std::sin(i), 0.1 * i}, i, 0.1, 0.2));
  const std::vector<Pose> odometry = drifted(path, none);
  for (std::size_t i = 0; i < path.size(); ++i)
    EXPECT_TRUE(odometry[i].isApprox(path[i], 1e-9)) << i;
  EXPECT_TRUE(drifted({}, none).empty());
}

TEST(OdometryDrift, FirstPoseIsRight) {
  const std::vector<Pose> path{pose_from_xyz_ypr({3, 2, 1}, 1, 0, 0)};
  EXPECT_TRUE(drifted(path)[0].isApprox(path[0]));
}

TEST(OdometryDrift, ErrorsHaveTheirDeviations) {
  DriftParams params{.translation_per_metre = 0.05,
                     .height_per_metre = 0.01,
                     .heading_per_metre = 0.02,
                     .heading_bias_per_metre = 0.01,
                     .tilt_per_stop = 0.003};
  constexpr int n = 4000;
  double forward = 0, height = 0, turn_sum = 0, turn_squares = 0, tilt = 0;
  for (int i = 0; i < n; ++i) {
    params.seed = static_cast<std::uint64_t>(i);
    const Pose end = drifted(straight(2, 2.0), params)[1];
    forward += std::pow(end.translation().x() - 2, 2) / n;
    height += std::pow(end.translation().z(), 2) / n;
    turn_sum += heading(end) / n;
    turn_squares += std::pow(heading(end) - 0.02, 2) / n;
    tilt += std::pow(end(2, 1), 2) / n;
  }
  EXPECT_NEAR(std::sqrt(forward), 0.05 * 2, 0.005);
  EXPECT_NEAR(std::sqrt(height), 0.01 * 2, 0.001);
  EXPECT_NEAR(turn_sum, 0.01 * 2, 0.003);
  EXPECT_NEAR(std::sqrt(turn_squares), 0.02 * 2, 0.002);
  EXPECT_NEAR(std::sqrt(tilt), 0.003, 0.0003);
}

TEST(OdometryDrift, TurningOnTheSpotCostsHeadingOnly) {
  DriftParams params = none;
  params.translation_per_metre = 0.1;
  params.heading_per_radian = 0.1;
  const std::vector<Pose> path{Pose::Identity(), pose_from_xyz_ypr({0, 0, 0}, 1, 0, 0)};
  const Pose end = drifted(path, params)[1];
  EXPECT_LT(end.translation().norm(), 1e-12);
  EXPECT_GT(std::abs(heading(end) - 1), 1e-4);
}

TEST(OdometryDrift, GrowsAlongThePath) {
  double early = 0, late = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::vector<Pose> truth = straight(40, 1.0);
    const std::vector<Pose> odometry = drifted(truth, {.seed = seed});
    early += (odometry[5].translation() - truth[5].translation()).squaredNorm();
    late += (odometry[39].translation() - truth[39].translation()).squaredNorm();
  }
  EXPECT_GT(late, 30 * early);
}

TEST(OdometryDrift, RefusesNegativeDeviations) {
  EXPECT_EQ(message_of([] { drifted({}, {.heading_per_metre = -0.1}); }),
            "heading_per_metre is -0.1, must be at least 0");
}

}  // namespace
}  // namespace planum
