#include "slam/registration/metascan.hpp"

#include <gtest/gtest.h>

#include "slam/registration/pair_matchers.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::shift_between;
using testing::Walk;

/// Stops in the room; the laser looks ahead only, and at the last stop the robot has turned round.
Walk turned_walk() {
  return testing::walk_in_room(
      {pose_from_xyz_ypr({3.6, 1.0, 1}, 3.3, 0, 0), pose_from_xyz_ypr({2.9, 0.9, 1}, 3.0, 0, 0),
       pose_from_xyz_ypr({2.4, 0.9, 1}, 0.0, 0, 0), pose_from_xyz_ypr({2.9, 1.0, 1}, 3.2, 0, 0)});
}

TEST(Merged, HoldsThePointsAndSurfacesOfAllScans) {
  const Walk walk = turned_walk();
  const Pose frame = walk.truth[1].inverse();
  const std::vector<PlacedScan> placed = {{&walk.scans[0], frame * walk.truth[0]},
                                          {&walk.scans[1], frame * walk.truth[1]}};
  const MatchingScan both = merged(placed);
  ASSERT_EQ(both.points.size(), walk.scans[0].points.size() + walk.scans[1].points.size());
  ASSERT_EQ(both.planes.size(), both.points.size());
  EXPECT_EQ(both.coarse.size(), walk.scans[0].coarse.size() + walk.scans[1].coarse.size());
  EXPECT_EQ(both.shuffled.size(), both.points.size());
  for (std::size_t i = 0; i < both.points.size(); i += 37) {
    const bool first = i < walk.scans[0].points.size();
    const MatchingScan& scan = walk.scans[first ? 0 : 1];
    const std::size_t k = first ? i : i - walk.scans[0].points.size();
    const Pose& pose = placed[first ? 0 : 1].frame_from_scan;
    const Eigen::Vector3d point = pose * scan.points[k].cast<double>();
    EXPECT_LT((both.points[i].cast<double>() - point).norm(), 1e-5);
    EXPECT_LT((both.planes[i].normal.cast<double>() -
               pose.linear() * scan.planes[k].normal.cast<double>())
                  .norm(),
              1e-5);
    const auto nearest = both.tree.nearest(both.points[i], 0.01f);
    ASSERT_TRUE(nearest);
    EXPECT_EQ(nearest->squared_distance, 0);
  }
  EXPECT_TRUE(merged(std::span<const PlacedScan>{}).points.empty());
}

TEST(Metascan, TakesTheScansThatOverlapMost) {
  const Walk walk = turned_walk();
  const auto earlier = std::span(walk.truth).first(3);
  const Pose guess = walk.truth[2].inverse() * walk.truth[3];
  // The last stop looks where the second one looked, not where the one before it did.
  EXPECT_EQ(metascan_members(walk.scans, earlier, guess, {.scans = 1}),
            (std::vector<std::size_t>{1}));
  EXPECT_EQ(metascan_members(walk.scans, earlier, guess), (std::vector<std::size_t>{1, 2}));
  EXPECT_TRUE(metascan_members(walk.scans, {}, guess).empty());
  EXPECT_TRUE(metascan_members(walk.scans, earlier, Pose(Eigen::Translation3d(40, 0, 0))).empty());
}

TEST(Metascan, MatchesWhatTheLastScanDoesNotSee) {
  const Walk walk = turned_walk();
  const auto earlier = std::span(walk.truth).first(3);
  const Pose truth = walk.truth[2].inverse() * walk.truth[3];
  const Pose guess = truth * pose_from_xyz_ypr({0.1, -0.05, 0.02}, 0.04, 0, 0);
  const Alignment alone = icp_matcher(walk.scans)(2, 3, guess);
  const Alignment together = icp_metascan_matcher(walk.scans)(earlier, guess, 0);
  EXPECT_TRUE(together.converged);
  EXPECT_GT(together.overlap, 0.8);
  EXPECT_LT(alone.overlap, together.overlap / 2);
  EXPECT_LT(shift_between(together.target_from_source, truth), 0.01);
  EXPECT_LT(rotation_angle(together.target_from_source, truth), radians(0.2));
}

TEST(Metascan, OfNothingNearGivesTheGuessBack) {
  const Walk walk = turned_walk();
  const Pose far(Eigen::Translation3d(40, 0, 0));
  const Alignment alignment =
      icp_metascan_matcher(walk.scans)(std::span(walk.truth).first(3), far, 0);
  EXPECT_EQ(alignment.pairs, 0u);
  EXPECT_TRUE(alignment.target_from_source.isApprox(far));
}

}  // namespace
}  // namespace planum
