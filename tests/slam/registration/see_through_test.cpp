#include "slam/registration/see_through.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::random_motion;
using testing::scan_of;

const Pose here = pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.5, 0, 0);
const Pose there = pose_from_xyz_ypr({2.2, 2.0, 1.0}, 1.6, 0.02, -0.01);

struct Views {
  RangeView target, source;
  Pose truth = here.inverse() * there;
};

Views views(const RangeViewParams& params = {}) {
  const Building room = testing::furnished_room();
  return {range_view(matching_scan(scan_of(room, here, 0)), params),
          range_view(matching_scan(scan_of(room, there, 1)), params)};
}

TEST(SeeThrough, IsRareAtTheRightPoseAndALittleOff) {
  const Views v = views();
  std::mt19937 random(3);
  for (int n = 0; n < 20; ++n) {
    const Pose pose = v.truth * random_motion(random, 0.02, radians(0.5));
    const FreeSpaceCheck check = check_free_space(v.source, v.target, pose);
    EXPECT_LT(check.contradicted(), 0.02);
    EXPECT_GT(check.source_from_target.agreements, 200u);
    EXPECT_GT(check.target_from_source.agreements, 200u);
  }
}

TEST(SeeThrough, IsFrequentAtWrongPoses) {
  const Views v = views();
  for (const double turn : {90.0, 180.0, 270.0}) {
    const Pose wrong = v.truth * pose_from_xyz_ypr({0, 0, 0}, radians(turn), 0, 0);
    EXPECT_GT(check_free_space(v.source, v.target, wrong).contradicted(), 2 * most_contradicted)
        << turn;
  }
  for (const Eigen::Vector3d& shift :
       {Eigen::Vector3d(0.6, 0, 0), Eigen::Vector3d(0, -0.6, 0), Eigen::Vector3d(0, 0, 0.5)}) {
    const Pose wrong = v.truth * Pose(Eigen::Translation3d(shift));
    EXPECT_GT(check_free_space(v.source, v.target, wrong).contradicted(), 2 * most_contradicted)
        << shift.transpose();
  }
}

TEST(SeeThrough, SampledSurfacesAreEachCountedOnce) {
  const Views v = views({.samples = 500});
  const Visibility seen = visibility(v.source, v.target, v.truth);
  EXPECT_LE(v.source.samples.size(), 500u);
  EXPECT_EQ(seen.contradictions + seen.agreements + seen.occluded + seen.unseen,
            v.source.samples.size());
}

TEST(SeeThrough, WhatIsHiddenIsNoContradiction) {
  // A wall two metres behind the one that the target sees.
  Cloud near, far;
  for (int i = -40; i <= 40; ++i)
    for (int k = -40; k <= 40; ++k) {
      near.points.emplace_back(2, 0.05f * static_cast<float>(i), 0.05f * static_cast<float>(k));
      far.points.emplace_back(4, 0.05f * static_cast<float>(i), 0.05f * static_cast<float>(k));
    }
  const RangeView a = range_view(matching_scan(near)), b = range_view(matching_scan(far));
  const Visibility hidden = visibility(b, a, Pose::Identity());
  EXPECT_GT(hidden.occluded, 500u);
  EXPECT_EQ(hidden.contradictions, 0u);
  const Visibility passed = visibility(a, b, Pose::Identity());
  EXPECT_GT(passed.contradictions, 500u);
  EXPECT_EQ(passed.occluded, 0u);
}

TEST(SeeThrough, DoesNotDependOnWhereTheScannersNorthIs) {
  const Views v = views();
  const Building room = testing::furnished_room();
  const Pose turn = pose_from_xyz_ypr({0, 0, 0}, 2.3, 0, 0);
  const RangeView turned = range_view(matching_scan(transformed(scan_of(room, here, 0), turn)));
  const double before = visibility(v.source, v.target, v.truth).contradicted();
  const double after = visibility(v.source, turned, turn * v.truth).contradicted();
  EXPECT_NEAR(before, after, 0.01);
  // At the poles bins meet: a scan that looks along the axis of its bins.
  const Pose up = pose_from_xyz_ypr({0, 0, 0}, 0, radians(-90), 0);
  const RangeView lying = range_view(matching_scan(transformed(scan_of(room, here, 0), up)));
  EXPECT_LT(visibility(v.source, lying, up * v.truth).contradicted(), 0.02);
}

TEST(SeeThrough, EmptyScansContradictNothing) {
  const RangeView empty = range_view(matching_scan({}));
  const Views v = views();
  EXPECT_EQ(check_free_space(empty, v.target, Pose::Identity()).contradicted(), 0);
  EXPECT_EQ(check_free_space(v.source, empty, Pose::Identity()).contradicted(), 0);
  Cloud few;
  few.points = {{0, 0, 0}, {0, 0, 1}, {0, 0, -1}};
  const RangeView lone = range_view(matching_scan(few));
  EXPECT_EQ(check_free_space(lone, v.target, Pose::Identity()).contradicted(), 0);
}

TEST(SeeThrough, RefusesBadParameters) {
  EXPECT_EQ(message_of([] { range_view(matching_scan({}), {.bin = 0}); }),
            "range view: bin must be between 0.1 and 30 deg, got 0");
  EXPECT_EQ(message_of([] { range_view(matching_scan({}), {.margin = 0}); }),
            "range view: margin must be > 0 m, got 0");
}

}  // namespace
}  // namespace planum
