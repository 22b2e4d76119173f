#include "slam/registration/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

constexpr PairGate wide{.distance = 0.4, .residual = 0.4, .max_normal_angle = radians(45)};

MatchingScan room_scan(const Pose& pose, std::uint64_t number) {
  return matching_scan(testing::scan_of(testing::furnished_room(), pose, number), {.voxel = 0.15});
}

std::vector<std::uint32_t> all(const MatchingScan& scan) { return scan.selection(0); }

TEST(Pairing, FindsTheNearestPointWhileTheSourceMoves) {
  const MatchingScan target = room_scan(Pose(Eigen::Translation3d(1.5, 1.5, 1)), 1);
  const MatchingScan source = room_scan(Pose(Eigen::Translation3d(1.6, 1.5, 1)), 2);
  PairFinder finder(source, target, all(source));
  std::mt19937 random(5);
  for (int step = 0; step < 4; ++step) {
    const Pose pose = testing::random_motion(random, 0.15, 0.05);
    std::size_t at = 0;
    const std::vector<Pair> pairs = finder.find(pose, Pairing::point_to_point, wide);
    ASSERT_GT(pairs.size(), source.points.size() / 2);
    for (std::size_t s = 0; s < source.points.size() && at < pairs.size(); ++s) {
      const Eigen::Vector3d p = pose * source.points[s].cast<double>();
      if (pairs[at].source != p) continue;
      double nearest = 1e9;
      for (const Eigen::Vector3f& q : target.points)
        nearest = std::min(nearest, (q.cast<double>() - p).norm());
      EXPECT_NEAR((pairs[at].target - p).norm(), nearest, 1e-5);
      ++at;
    }
    EXPECT_EQ(at, pairs.size()) << "pairs come in the order of the selection";
  }
}

TEST(Pairing, ANewSelectionPairsAsIfItWereTheFirst) {
  const MatchingScan target = room_scan(Pose(Eigen::Translation3d(1.5, 1.5, 1)), 1);
  const MatchingScan source = room_scan(Pose(Eigen::Translation3d(1.6, 1.5, 1)), 2);
  std::mt19937 random(8);
  PairFinder finder(source, target, source.selection(200));
  for (const std::size_t most : {200u, 700u, 300u, 0u}) {
    const auto selection = source.selection(most);
    finder.select(selection);
    ASSERT_EQ(finder.selected(), selection.size());
    PairFinder fresh(source, target, selection);
    for (int step = 0; step < 3; ++step) {
      const Pose pose = testing::random_motion(random, 0.1, 0.03);
      const auto pairs = finder.find(pose, Pairing::point_to_plane, wide),
                 expected = fresh.find(pose, Pairing::point_to_plane, wide);
      ASSERT_EQ(pairs.size(), expected.size());
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_EQ(pairs[i].source, expected[i].source);
        EXPECT_EQ(pairs[i].target, expected[i].target);
      }
    }
  }
}

TEST(Pairing, NeverPairsTheTwoSidesOfAThinWall) {
  // The same wall, 4 cm thick, seen from x = 0 and from x = 4.
  Cloud front, back;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 40; ++j) {
      const float y = -1.5f + 0.05f * static_cast<float>(i), z = -1 + 0.05f * static_cast<float>(j);
      front.points.emplace_back(2, y, z);
      back.points.emplace_back(-1.96f, y, z);
    }
  const MatchingScan target = matching_scan(front), source = matching_scan(back);
  const Pose target_from_source(Eigen::Translation3d(4, 0, 0));
  PairFinder finder(source, target, all(source));
  EXPECT_TRUE(finder.find(target_from_source, Pairing::point_to_plane, wide).empty());
  EXPECT_TRUE(finder.find(target_from_source, Pairing::point_to_point, wide).empty());
}

TEST(Pairing, WeightsFallToNothingAtTheGate) {
  Cloud wall, moved;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 40; ++j) {
      wall.points.emplace_back(2, -1.5f + 0.05f * static_cast<float>(i),
                               -1 + 0.05f * static_cast<float>(j));
      moved.points.push_back(wall.points.back() + Eigen::Vector3f(0.05f, 0, 0));
    }
  const MatchingScan target = matching_scan(wall), source = matching_scan(moved);
  PairFinder finder(source, target, all(source));
  const auto weight_at = [&](double gate) {
    const auto pairs = finder.find(Pose::Identity(), Pairing::point_to_plane,
                                   {.distance = 1, .residual = gate, .max_normal_angle = 1});
    return pairs.empty() ? 0.0 : pairs.front().weight;
  };
  EXPECT_EQ(weight_at(0.049), 0);
  EXPECT_NEAR(weight_at(0.1), std::pow(1 - 0.25, 2), 1e-3);
  EXPECT_NEAR(weight_at(1), 1, 0.01);
}

TEST(Pairing, KnowsHowManyPairsShareTheirNoise) {
  const MatchingScan scan = room_scan(Pose(Eigen::Translation3d(1.5, 1.5, 1)), 1);
  const PairFinder every(scan, scan, all(scan));
  EXPECT_DOUBLE_EQ(every.redundancy(Pairing::point_to_plane), 12);
  EXPECT_DOUBLE_EQ(every.redundancy(Pairing::point_to_point), 1);
  const PairFinder few(scan, scan, scan.selection(20));
  EXPECT_DOUBLE_EQ(few.redundancy(Pairing::point_to_plane), 1);
}

}  // namespace
}  // namespace planum
