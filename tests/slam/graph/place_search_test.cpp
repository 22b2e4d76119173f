#include "slam/graph/place_search.hpp"

#include <random>

#include <gtest/gtest.h>

#include "slam/sensor/random_building.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::scan_of;
using testing::shift_between;

const Pose here = pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.5, 0, 0);

MatchingScan seen_from(const Building& building, const Pose& pose, std::uint64_t number) {
  return matching_scan(scan_of(building, pose, number));
}

/// An empty room of 5 m by 5 m: it looks the same after a quarter of a turn.
Building square_room() {
  BuildingPlan plan;
  plan.rooms = {
      {.name = "room", .walls = {.outer = {{0, 0}, {5, 0}, {5, 5}, {0, 5}}}, .height = 2.6}};
  return built(plan);
}

TEST(Locate, FindsAPoseOfWhichNothingIsKnown) {
  const Building room = testing::furnished_room();
  const MatchingScan target = seen_from(room, here, 0);
  std::uint64_t number = 1;
  for (const Pose& pose : {pose_from_xyz_ypr({1.8, 1.4, 1.0}, 1.2, 0, 0),
                           pose_from_xyz_ypr({1.6, 2.4, 1.1}, -0.2, 0.03, -0.02),
                           pose_from_xyz_ypr({0.8, 0.8, 1.0}, 0.9, 0, 0.02)}) {
    const Location location = locate(seen_from(room, pose, number++), target);
    EXPECT_TRUE(location.found) << location.reason;
    const Pose truth = here.inverse() * pose;
    EXPECT_LT(shift_between(location.alignment.target_from_source, truth), 0.02);
    EXPECT_LT(rotation_angle(location.alignment.target_from_source, truth), radians(0.5));
    EXPECT_GT(location.evidence.overlap, 0.3);
    EXPECT_LT(location.evidence.contradicted, 0.025);
  }
}

TEST(Locate, DoesNotCareWhichWayAScanIsTurned) {
  const Building room = testing::furnished_room();
  const MatchingScan target = seen_from(room, here, 0);
  const Pose pose = pose_from_xyz_ypr({1.8, 1.4, 1.0}, 1.2, 0, 0);
  const Cloud cloud = scan_of(room, pose, 1);
  for (const double turn : {0.7, 2.5, -2.0}) {
    const Pose turned_from_scan = pose_from_xyz_ypr({0, 0, 0}, turn, 0, 0);
    const Location location = locate(matching_scan(transformed(cloud, turned_from_scan)), target);
    ASSERT_TRUE(location.found) << location.reason;
    EXPECT_LT(shift_between(location.alignment.target_from_source * turned_from_scan,
                            here.inverse() * pose),
              0.02);
  }
}

TEST(Locate, GivesNoAnswerWhereSeveralSuit) {
  const Building room = square_room();
  // A whole turn each: four scans in one, as of a scanner that sees all round.
  const auto all_round = [&](double x, double y, std::uint64_t number) {
    Cloud all;
    for (int k = 0; k < 4; ++k) {
      const Pose turn = pose_from_xyz_ypr({0, 0, 0}, radians(90 * k), 0, 0);
      const Pose pose = pose_from_xyz_ypr({x, y, 1.0}, 0, 0, 0) * turn;
      const Cloud part =
          transformed(scan_of(room, pose, number + static_cast<std::uint64_t>(k)), turn);
      all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    }
    return matching_scan(all);
  };
  const Location location = locate(all_round(2.0, 2.2, 0), all_round(2.9, 2.6, 10));
  EXPECT_FALSE(location.found);
  EXPECT_NE(location.reason.find("away suits as well"), std::string::npos) << location.reason;
}

TEST(Locate, GivesNoAnswerInABareCorridor) {
  const Building corridor = testing::bare_corridor();
  const Location location =
      locate(seen_from(corridor, pose_from_xyz_ypr({0, 0, 1}, 0, 0, 0), 0),
             seen_from(corridor, pose_from_xyz_ypr({1.5, 0.2, 1}, 0.1, 0, 0), 1));
  EXPECT_FALSE(location.found);
  EXPECT_FALSE(location.reason.empty());
}

TEST(Locate, GivesNoAnswerForScansOfDifferentRooms) {
  const MatchingScan room = seen_from(testing::furnished_room(), here, 0);
  const RandomBuilding other = random_building(5);
  for (std::size_t k = 0; k < 3; ++k) {
    const Location location = locate(seen_from(other.building, other.poses[3 * k], k), room);
    EXPECT_FALSE(location.found);
    EXPECT_FALSE(location.reason.empty());
  }
}

TEST(Locate, GivesNoAnswerForScansOfNothing) {
  const MatchingScan room = seen_from(testing::furnished_room(), here, 0);
  Cloud few;
  few.points = {{1, 0, 0}, {1, 0.1f, 0}, {1, 0, 0.1f}};
  for (const MatchingScan& scan : {matching_scan({}), matching_scan(few)}) {
    EXPECT_FALSE(locate(scan, room).found);
    EXPECT_FALSE(locate(room, scan).found);
    EXPECT_FALSE(locate(scan, scan).found);
  }
}

TEST(Locate, RefusesBadParameters) {
  EXPECT_EQ(message_of([] { locate(matching_scan({}), matching_scan({}), {.min_overlap = 2}); }),
            "place search: min_overlap must be between 0 and 1, got 2");
  EXPECT_EQ(message_of([] { matches_of_plans({}, {}, {.max_distance = 0}); }),
            "scan plan: max_distance must be above 0, at most 32 m, got 0");
}

struct Walk {
  std::vector<Pose> truth;
  std::vector<MatchingScan> scans;
};

Walk walk() {
  const RandomBuilding building = random_building(7, 3);
  Walk result;
  for (const Pose& pose : building.poses) {
    result.truth.push_back(pose);
    result.scans.push_back(seen_from(building.building, pose, result.scans.size()));
  }
  return result;
}

TEST(FindPlaces, PutsRightPairsFirst) {
  const Walk w = walk();
  const std::vector<PlaceCandidate> found = find_places(w.scans);
  ASSERT_GE(found.size(), 5u);
  std::size_t right = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_LT(found[k].target, found[k].source);
    const Pose off = (w.truth[found[k].target].inverse() * w.truth[found[k].source]).inverse() *
                     found[k].target_from_source;
    right += off.translation().norm() < 0.6 && rotation_angle(off) < radians(8);
  }
  EXPECT_GE(right, 4u);
  for (std::size_t k = 1; k < found.size(); ++k) EXPECT_GE(found[k - 1].score, found[k].score);
}

TEST(FindPlaces, AreTheSameForAnyNumberOfThreads) {
  const Walk w = walk();
  const auto with = [&](int threads) {
    const testing::ThreadCount count(threads);
    return find_places(w.scans);
  };
  const auto one = with(1), many = with(4);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].target, many[k].target);
    EXPECT_EQ(one[k].source, many[k].source);
    EXPECT_EQ(one[k].target_from_source.matrix(), many[k].target_from_source.matrix());
    EXPECT_EQ(one[k].score, many[k].score);
  }
}

TEST(FindPlaces, NeedsScans) {
  EXPECT_TRUE(find_places(std::span<const MatchingScan>{}).empty());
  const std::vector<MatchingScan> nothing = {matching_scan({}), matching_scan({})};
  EXPECT_TRUE(find_places(nothing).empty());
}

}  // namespace
}  // namespace planum
