#include "slam/registration/reduction.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;

std::vector<Eigen::Vector3f> random_points(std::mt19937& random, std::size_t count, float extent) {
  std::uniform_real_distribution<float> coordinate(-extent, extent);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& p : points)
    p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

/// The voxels with their points, the slow way.
std::map<std::array<long, 3>, std::vector<std::uint32_t>> voxels_of(
    const std::vector<Eigen::Vector3f>& points, double voxel) {
  std::map<std::array<long, 3>, std::vector<std::uint32_t>> voxels;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::array<long, 3> key{};
    for (int axis = 0; axis < 3; ++axis)
      key[static_cast<std::size_t>(axis)] = std::lround(std::floor(points[i][axis] / voxel));
    voxels[key].push_back(i);
  }
  return voxels;
}

TEST(Reduction, KeepsThePointNearestTheMeanOfEachVoxel) {
  std::mt19937 random(1);
  for (const double voxel : {0.125, 0.5, 3.0}) {
    const std::vector<Eigen::Vector3f> points = random_points(random, 3000, 2);
    const VoxelGrid grid = voxel_grid(points, voxel);
    const auto voxels = voxels_of(points, voxel);
    ASSERT_EQ(grid.representative.size(), voxels.size());
    for (const auto& [key, members] : voxels) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const std::uint32_t i : members)
        mean += points[i].cast<double>() / static_cast<double>(members.size());
      double nearest = std::numeric_limits<double>::infinity();
      for (const std::uint32_t i : members)
        nearest = std::min(nearest, (points[i].cast<double>() - mean).norm());
      const std::uint32_t v = grid.voxel_of_point[members.front()];
      for (const std::uint32_t i : members) EXPECT_EQ(grid.voxel_of_point[i], v);
      const double kept = (points[grid.representative[v]].cast<double>() - mean).norm();
      EXPECT_NEAR(kept, nearest, 1e-5);
    }
  }
}

TEST(Reduction, NumbersVoxelsInTheOrderInWhichTheyAreSeen) {
  std::mt19937 random(2);
  const VoxelGrid grid = voxel_grid(random_points(random, 500, 1), 0.3);
  std::uint32_t seen = 0;
  for (const std::uint32_t v : grid.voxel_of_point) {
    ASSERT_LE(v, seen);
    if (v == seen) ++seen;
  }
}

TEST(Reduction, KeepsTheAttributesOfTheKeptPoints) {
  std::mt19937 random(3);
  Cloud cloud{.points = random_points(random, 400, 1), .normals = {}, .intensity = {}, .scan = {}};
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    cloud.intensity.push_back(cloud.points[i].x());
    cloud.scan.push_back(static_cast<std::uint32_t>(i));
  }
  const Cloud kept = reduced(cloud, 0.4);
  ASSERT_LT(kept.points.size(), cloud.points.size());
  ASSERT_EQ(kept.intensity.size(), kept.points.size());
  EXPECT_TRUE(kept.normals.empty());
  for (std::size_t i = 0; i < kept.points.size(); ++i) {
    EXPECT_EQ(kept.intensity[i], kept.points[i].x());
    EXPECT_EQ(cloud.points[kept.scan[i]], kept.points[i]);
  }
}

TEST(Reduction, KeepsEverythingWithoutAVoxel) {
  std::mt19937 random(4);
  const Cloud cloud{
      .points = random_points(random, 50, 1), .normals = {}, .intensity = {}, .scan = {}};
  EXPECT_EQ(reduced(cloud, 0).points, cloud.points);
}

TEST(Reduction, LeavesAnEmptyCloudEmpty) { EXPECT_TRUE(reduced(Cloud{}, 0.1).points.empty()); }

TEST(Reduction, RefusesWhatItCannotSort) {
  const std::vector<Eigen::Vector3f> good = {{1, 2, 3}};
  EXPECT_NE(message_of([&] { voxel_grid(good, -0.1); }).find("voxel must be positive, got -0.1"),
            std::string::npos);
  EXPECT_NE(message_of([&] { voxel_grid(good, std::nan("")); }).find("voxel must be positive"),
            std::string::npos);
  const std::vector<Eigen::Vector3f> bad = {{0, 0, 0}, {0, std::nanf(""), 0}};
  EXPECT_NE(message_of([&] { voxel_grid(bad, 0.1); }).find("point 1 (0, nan, 0) is not finite"),
            std::string::npos);
  const std::vector<Eigen::Vector3f> far = {{0, 0, 1e9f}};
  EXPECT_NE(message_of([&] { voxel_grid(far, 0.1); }).find("the reach of a voxel of 0.1 m"),
            std::string::npos);
}

}  // namespace
}  // namespace planum
