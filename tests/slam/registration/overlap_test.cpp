#include "slam/registration/overlap.hpp"

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

TEST(EstimatedOverlap, IsGreatWhereScansSeeTheSameAndNothingFarAway) {
  const Building room = testing::furnished_room();
  const Pose at_a = pose_from_xyz_ypr({1.2, 1.4, 1.0}, 0.5, 0, 0);
  const Pose at_b = pose_from_xyz_ypr({1.9, 1.9, 1.0}, 0.9, 0, 0);
  const MatchingScan a = matching_scan(testing::scan_of(room, at_a, 1));
  const MatchingScan b = matching_scan(testing::scan_of(room, at_b, 2));
  EXPECT_GT(estimated_overlap(b, a, at_a.inverse() * at_b), 0.7);
  EXPECT_GT(estimated_overlap(a, a, Pose::Identity()), 0.85);
  EXPECT_EQ(estimated_overlap(b, a, Pose(Eigen::Translation3d(50, 0, 0))), 0);
  EXPECT_EQ(estimated_overlap(matching_scan({}), a, Pose::Identity()), 0);
  EXPECT_EQ(estimated_overlap(a, matching_scan({}), Pose::Identity()), 0);
}

}  // namespace
}  // namespace planum
