#include "labeling/rooms/openings.hpp"

#include <random>

#include <gtest/gtest.h>

#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/random_building.hpp"
#include "tests/labeling/scanned_building.hpp"

namespace planum {
namespace {

using testing::rooms_in;
using testing::scanned;

TEST(Openings, FindsAndMeasuresTheDoorsOfTheDemonstration) {
  const Building building = demo_building();
  const RoomMap rooms = rooms_in(scanned(building.mesh.mesh, demo_poses()));
  EXPECT_EQ(testing::count(rooms, OpeningKind::door), building.doors.size());
  EXPECT_EQ(testing::count(rooms, OpeningKind::passage), 0u);
  for (const TrueDoor& door : building.doors) {
    const std::string which = door.between[0] + " - " + door.between[1];
    const Opening* found = testing::opening_at(rooms, door.centre);
    ASSERT_TRUE(found) << which;
    EXPECT_NEAR(found->width, door.width, 0.03) << which;
    EXPECT_NEAR(found->height, door.height, 0.05) << which;
    EXPECT_LT((found->position - door.centre).norm(), 0.05) << which;
    EXPECT_NEAR(found->thickness, 0.15, 0.03) << which;
    EXPECT_EQ(found->rooms.size(), 2u) << which;
  }
}

TEST(Openings, UnseenBuildingsHaveNoDoorTooMany) {
  for (const std::uint64_t seed : {3, 4}) {
    SCOPED_TRACE(seed);
    const RandomBuilding random = random_building(seed, 4);
    const RoomMap rooms = rooms_in(scanned(random.building.mesh.mesh, random.poses));
    std::size_t matched = 0;
    for (const TrueDoor& door : random.building.doors) {
      const Opening* found = testing::opening_at(rooms, door.centre);
      if (!found) continue;
      ++matched;
      EXPECT_NEAR(found->width, door.width, 0.05);
      EXPECT_LT((found->position - door.centre).head<2>().norm(), 0.05);
    }
    // The frames of the first two doors are hardly seen: the path starts beside them, looking away.
    EXPECT_GE(matched, random.building.doors.size() - 2);
    EXPECT_EQ(
        testing::count(rooms, OpeningKind::door) + testing::count(rooms, OpeningKind::passage),
        matched);
  }
}

TEST(Openings, PartsTwoSetsWithTheFewestErrors) {
  const EdgeInterval clean = parting_interval({0.1, 0.2, 0.3}, {0.4, 0.5}, 0.33, 0.15);
  EXPECT_DOUBLE_EQ(clean.low, 0.3);
  EXPECT_DOUBLE_EQ(clean.high, 0.4);
  const EdgeInterval with_stray =
      parting_interval({0.1, 0.2, 0.3, 0.41}, {0.25, 0.39, 0.4, 0.45, 0.5}, 0.33, 0.15);
  EXPECT_DOUBLE_EQ(with_stray.low, 0.3);
  EXPECT_DOUBLE_EQ(with_stray.high, 0.39);
}

TEST(Openings, PartingAgreesWithTryingAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-0.2, 0.2);
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<double> below, above;
    for (int i = 0; i < 8; ++i) below.push_back(spread(random) - 0.1);
    for (int i = 0; i < 8; ++i) above.push_back(spread(random) + 0.1);
    const auto wrong = [&](double value) {
      return std::count_if(below.begin(), below.end(), [&](double v) { return v > value; }) +
             std::count_if(above.begin(), above.end(), [&](double v) { return v < value; });
    };
    std::ptrdiff_t least = 100;
    for (double value = -0.1499; value < 0.15; value += 0.0002)
      least = std::min(least, wrong(value));
    const EdgeInterval found = parting_interval(below, above, 0, 0.15);
    EXPECT_LE(wrong(found.middle()), least);
  }
}

/// Rays and points around a door from u = 0 to 0.9 and up to 2 m, with noise.
OpeningEvidence evidence_of_a_door(std::size_t jamb_points) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-0.4, 1.3), z(0, 2.5), height(0.2, 1.9);
  std::normal_distribution<double> noise(0, 0.01);
  OpeningEvidence evidence;
  for (int i = 0; i < 3000; ++i) {
    const OpeningSample sample{u(random), z(random), 0, 0};
    const bool open = sample.u > 0 && sample.u < 0.9 && sample.z < 2;
    (open ? evidence.crossings : evidence.hits).push_back(sample);
  }
  for (std::size_t i = 0; i < jamb_points; ++i) {
    evidence.reveal.push_back({noise(random), height(random), 1, 0});
    evidence.reveal.push_back({0.9 + noise(random), height(random), -1, 0});
  }
  return evidence;
}

TEST(Openings, EdgesAreWhereRaysEndAndPointsBegin) {
  const OpeningRectangle door = refined({0.05, 0.85, 0, 1.95}, evidence_of_a_door(0), false);
  EXPECT_NEAR(door.left, 0, 0.01);
  EXPECT_NEAR(door.right, 0.9, 0.01);
  EXPECT_NEAR(door.top, 2, 0.01);
  EXPECT_EQ(door.bottom, 0);
}

TEST(Openings, JambsGiveTheEdgesMoreExactly) {
  const OpeningRectangle door = refined({0.05, 0.85, 0, 1.95}, evidence_of_a_door(400), false);
  EXPECT_NEAR(door.left, 0, 0.002);
  EXPECT_NEAR(door.right, 0.9, 0.002);
}

TEST(Openings, AnOpenLeafIsNoJamb) {
  OpeningEvidence evidence = evidence_of_a_door(100);
  // A leaf at a right angle, 10 cm inside the opening, with more points than the jamb.
  for (int i = 0; i < 20; ++i) evidence.reveal.push_back({0.1, 0.5 + 0.01 * i, 1, 0});
  const OpeningRectangle door = refined({0.05, 0.85, 0, 1.95}, evidence, false);
  EXPECT_NEAR(door.left, 0, 0.01);
}

TEST(Openings, HaveNames) {
  EXPECT_STREQ(name(OpeningKind::door), "door");
  EXPECT_STREQ(name(OpeningKind::window), "window");
  EXPECT_STREQ(name(OpeningKind::passage), "passage");
}

}  // namespace
}  // namespace planum
