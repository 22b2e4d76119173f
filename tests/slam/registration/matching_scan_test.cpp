#include "slam/registration/matching_scan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::ThreadCount;

/// Points of the plane z = height with noise, over a square round the axis.
Cloud noisy_plane(double height, double noise, std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-2, 2);
  std::normal_distribution<double> off(0, noise);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i)
    cloud.points.push_back(
        Eigen::Vector3d(along(random), along(random), height + off(random)).cast<float>());
  return cloud;
}

TEST(MatchingScan, FindsThePlaneOfAFloorAndItsNoise) {
  const MatchingScan scan = matching_scan(noisy_plane(-1, 0.008, 40000));
  EXPECT_NEAR(scan.noise, 0.008, 0.001);
  std::size_t known = 0;
  for (const LocalPlane& plane : scan.planes) {
    if (!plane.known()) continue;
    ++known;
    EXPECT_GT(plane.normal.z(), std::cos(radians(12))) << "towards the scanner, which is above";
    EXPECT_NEAR(plane.mean.z(), -1, 0.008);
  }
  EXPECT_GT(known, scan.points.size() * 9 / 10);
}

TEST(MatchingScan, TurnsNormalsToTheScannerBelowACeilingToo) {
  const MatchingScan scan = matching_scan(noisy_plane(2, 0.003, 20000));
  for (const LocalPlane& plane : scan.planes)
    if (plane.known()) {
      EXPECT_LT(plane.normal.z(), 0);
    }
}

TEST(MatchingScan, SmoothedPointsLieOnTheSurface) {
  const MatchingScan scan = matching_scan(noisy_plane(-1, 0.01, 40000));
  double raw = 0, smoothed = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    raw += std::pow(scan.points[i].z() + 1, 2);
    smoothed += std::pow(scan.smoothed(i).z() + 1, 2);
  }
  EXPECT_LT(smoothed, raw / 4);
}

TEST(MatchingScan, HasNoPlaneWhereThereIsALine) {
  Cloud cloud;
  for (int i = 0; i < 300; ++i) cloud.points.emplace_back(2, 0.02f * static_cast<float>(i), 0.5f);
  for (const LocalPlane& plane : matching_scan(cloud).planes) EXPECT_FALSE(plane.known());
}

TEST(MatchingScan, TakesAnEmptyScanAndASinglePoint) {
  EXPECT_TRUE(matching_scan({}).points.empty());
  Cloud one;
  one.points.emplace_back(1, 2, 3);
  const MatchingScan scan = matching_scan(one);
  ASSERT_EQ(scan.planes.size(), 1u);
  EXPECT_FALSE(scan.planes[0].known());
  EXPECT_EQ(scan.smoothed(0), scan.points[0]);
}

TEST(MatchingScan, IsTheSameForAnyNumberOfThreads) {
  const Cloud cloud =
      testing::scan_of(testing::furnished_room(), Pose(Eigen::Translation3d(1, 2, 1)));
  const auto with = [&](int threads) {
    const ThreadCount count(threads);
    return matching_scan(cloud);
  };
  const MatchingScan one = with(1), many = with(4);
  ASSERT_EQ(one.points, many.points);
  EXPECT_EQ(one.coarse, many.coarse);
  EXPECT_EQ(one.noise, many.noise);
  for (std::size_t i = 0; i < one.planes.size(); ++i) {
    EXPECT_EQ(one.planes[i].mean, many.planes[i].mean);
    EXPECT_EQ(one.planes[i].normal, many.planes[i].normal);
    EXPECT_EQ(one.planes[i].thickness, many.planes[i].thickness);
  }
}

TEST(MatchingScan, CoarseSelectionsAreEvenAndAscending) {
  const MatchingScan scan = matching_scan(
      testing::scan_of(testing::furnished_room(), Pose(Eigen::Translation3d(1, 2, 1))));
  const auto all = scan.coarse_selection(0), some = scan.coarse_selection(all.size() / 4);
  ASSERT_GT(all.size(), 200u);
  EXPECT_LT(all.size(), scan.points.size());
  EXPECT_EQ(some.size(), all.size() / 4);
  EXPECT_TRUE(std::is_sorted(some.begin(), some.end()));
  EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end()));
  // Even: the mean of a quarter of them lies where that of all lies.
  const auto mean = [&](const std::vector<std::uint32_t>& positions) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const std::uint32_t i : positions) sum += scan.points[i];
    return Eigen::Vector3f(sum / static_cast<float>(positions.size()));
  };
  EXPECT_LT((mean(all) - mean(some)).norm(), 0.4);
}

TEST(MatchingScan, RefusesBadInput) {
  Cloud bad;
  bad.points.emplace_back(0, 0, std::nanf(""));
  EXPECT_NE(message_of([&] { matching_scan(bad); }).find("is not finite"), std::string::npos);
  EXPECT_NE(message_of([&] {
              matching_scan({}, {.voxel = -1});
            }).find("registration: voxel must be >= 0 m, got -1"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              matching_scan({}, {.neighbours = 2});
            }).find("neighbours must be >= 4, got 2"),
            std::string::npos);
}

TEST(MatchingScan, SelectsByPlaceNotByPosition) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> coordinate(-5, 5);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  // The same scan with its first point lost and all others moved by a twentieth of a millimetre.
  std::vector<Eigen::Vector3f> other(points.begin() + 1, points.end());
  for (Eigen::Vector3f& p : other) p.x() += 5e-5f;
  const auto scan_of = [](std::vector<Eigen::Vector3f> p) {
    Cloud cloud;
    cloud.points = std::move(p);
    return matching_scan(cloud, {.voxel = 0});
  };
  const MatchingScan scan = scan_of(points);
  const auto chosen = scan.selection(500);
  const auto places = [](const MatchingScan& of, const std::vector<std::uint32_t>& positions) {
    std::set<std::pair<float, float>> result;  // y and z, which stayed
    for (const std::uint32_t i : positions) result.emplace(of.points[i].y(), of.points[i].z());
    return result;
  };
  const MatchingScan other_scan = scan_of(other);
  const auto first = places(scan, chosen), second = places(other_scan, other_scan.selection(500));
  ASSERT_EQ(first.size(), 500u);
  ASSERT_EQ(second.size(), 500u);
  std::vector<std::pair<float, float>> common;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(),
                        std::back_inserter(common));
  EXPECT_GT(common.size(), 485u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_EQ(scan.selection(0).size(), 5000u);
  EXPECT_EQ(scan_of({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}).selection(5),
            (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(scan_of({}).selection(5).empty());
}

}  // namespace
}  // namespace planum
