#include "slam/evaluation/segment_error.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

/// Along x, one pose every `step` metres; each step of the estimate is `scale` as long and turns by
/// `turn_deg`.
struct Walk {
  Trajectory truth, estimate;
};

Walk walk(int count, double step, double scale, double turn_deg) {
  Walk walk;
  Pose estimate = Pose::Identity();
  for (int i = 0; i < count; ++i) {
    walk.truth.push_back({1.0 * i, pose_from_xyz_ypr({step * i, 0, 0}, 0, 0, 0)});
    walk.estimate.push_back({1.0 * i, estimate});
    estimate = estimate * pose_from_xyz_ypr({scale * step, 0, 0}, radians(turn_deg), 0, 0);
  }
  return walk;
}

std::vector<double> lengths_of(const SegmentError& error) {
  std::vector<double> lengths;
  for (const SegmentsOfLength& segments : error.lengths) lengths.push_back(segments.length);
  return lengths;
}

TEST(SegmentError, IsTheScaleErrorOfStraightPathsAtEveryLength) {
  const Walk w = walk(31, 0.5, 1.02, 0);
  const SegmentError error = segment_error(w.estimate, w.truth);
  EXPECT_NEAR(error.path, 15, 1e-9);
  EXPECT_EQ(lengths_of(error), (std::vector<double>{0.5, 1, 2, 5, 10}));
  for (const SegmentsOfLength& segments : error.lengths) {
    EXPECT_NEAR(segments.mean_path, segments.length, 1e-9);
    EXPECT_NEAR(segments.translation.min, 0.02, 1e-9);
    EXPECT_NEAR(segments.translation.max, 0.02, 1e-9);
    EXPECT_NEAR(segments.rotation.max, 0, 1e-5);
    const double steps = std::round(segments.length / 0.5);
    EXPECT_EQ(segments.translation.count, static_cast<std::size_t>(31 - steps));
  }
  EXPECT_NEAR(error.translation.mean, 0.02, 1e-9);
}

TEST(SegmentError, IsTheTurnPerMetre) {
  const Walk w = walk(21, 1, 1, 0.3);
  const SegmentError error = segment_error(w.estimate, w.truth, {.lengths = {1, 4}});
  ASSERT_EQ(error.lengths.size(), 2u);
  EXPECT_NEAR(error.lengths[0].rotation.mean, 0.3, 1e-6);
  EXPECT_NEAR(error.lengths[1].rotation.mean, 0.3, 1e-6);
  EXPECT_NEAR(error.lengths[0].translation.max, 0, 1e-9);
  EXPECT_EQ(error.translation.count, 20u + 17u);
}

TEST(SegmentError, DividesByThePathBetweenThePoses) {
  const Walk w = walk(5, 3, 1.1, 0);
  const SegmentError error = segment_error(w.estimate, w.truth, {.lengths = {4}});
  ASSERT_EQ(error.lengths.size(), 1u);
  EXPECT_NEAR(error.lengths[0].mean_path, 6, 1e-9);
  EXPECT_NEAR(error.lengths[0].translation.mean, 0.1, 1e-9);
}

TEST(SegmentError, DoesNotChangeWhenEitherWorldIsMovedOrPosesAreShuffled) {
  std::mt19937 random(4);
  Walk w = walk(25, 0.7, 1.03, 1);
  const SegmentError before = segment_error(w.estimate, w.truth);
  const Pose other = pose_from_xyz_ypr({5, -3, 1}, 2, 0.3, -0.2);
  for (StampedPose& pose : w.estimate) pose.pose = other * pose.pose;
  for (StampedPose& pose : w.truth) pose.pose = other.inverse() * pose.pose;
  std::shuffle(w.truth.begin(), w.truth.end(), random);
  const SegmentError after = segment_error(w.estimate, w.truth);
  ASSERT_EQ(lengths_of(after), lengths_of(before));
  for (std::size_t k = 0; k < after.lengths.size(); ++k) {
    EXPECT_NEAR(after.lengths[k].translation.rmse, before.lengths[k].translation.rmse, 1e-9);
    EXPECT_NEAR(after.lengths[k].rotation.rmse, before.lengths[k].rotation.rmse, 1e-5);
    EXPECT_EQ(after.lengths[k].translation.count, before.lengths[k].translation.count);
  }
}

TEST(SegmentError, HasNoLengthsForAPathThatIsTooShort) {
  const Walk w = walk(3, 1, 1, 0);
  EXPECT_TRUE(segment_error(w.estimate, w.truth, {.lengths = {5}}).lengths.empty());
  const Walk still = walk(3, 0, 1, 0);
  const SegmentError error = segment_error(still.estimate, still.truth);
  EXPECT_TRUE(error.lengths.empty());
  EXPECT_EQ(error.translation.count, 0u);
  EXPECT_TRUE(segment_error({w.estimate[0]}, {w.truth[0]}).lengths.empty());
}

TEST(SegmentError, SaysWhatIsWrong) {
  Walk w = walk(5, 1, 1, 0);
  EXPECT_THROW(segment_error(w.estimate, w.truth, {.lengths = {0}}), Error);
  EXPECT_THROW(segment_error(w.estimate, w.truth, {.lengths = {NAN}}), Error);
  EXPECT_THROW(segment_error(w.estimate, w.truth, {.stride = 0}), Error);
  EXPECT_THROW(segment_error(w.estimate, w.truth, {.max_stamp_difference = -1}), Error);
  EXPECT_THROW(segment_error({}, w.truth), Error);
  w.truth[2].pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(segment_error(w.estimate, w.truth), Error);
}

}  // namespace
}  // namespace planum
