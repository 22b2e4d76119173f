#include "slam/core/cloud.hpp"

#include <gtest/gtest.h>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

Cloud small_cloud(int n) {
  Cloud cloud;
  for (int i = 0; i < n; ++i) {
    cloud.points.emplace_back(float(i), float(i % 7), 1.0f);
    cloud.normals.push_back(Eigen::Vector3f(1, float(i % 3), 0).normalized());
    cloud.intensity.push_back(float(i) / 2);
  }
  return cloud;
}

TEST(Cloud, MovesPointsAndTurnsNormals) {
  const Pose pose = pose_from_xyz_ypr({1, 2, 3}, 0.7, -0.2, 0.1);
  const Cloud before = small_cloud(100), after = transformed(before, pose);
  for (std::size_t i = 0; i < before.points.size(); ++i) {
    EXPECT_LT((after.points[i].cast<double>() - pose * before.points[i].cast<double>()).norm(),
              1e-5);
    EXPECT_LT(
        (after.normals[i].cast<double>() - pose.linear() * before.normals[i].cast<double>()).norm(),
        1e-6);
    EXPECT_EQ(after.intensity[i], before.intensity[i]);
  }
}

TEST(Cloud, MergedPointsKnowTheirScan) {
  std::vector<Scan> scans(3);
  scans[0].cloud = small_cloud(10);
  scans[1].cloud = Cloud{};
  scans[2].cloud = small_cloud(20);
  scans[2].world_from_scan.translation() = Eigen::Vector3d(0, 0, 5);
  const Cloud cloud = merged(scans);
  ASSERT_EQ(cloud.points.size(), 30u);
  EXPECT_EQ(cloud.scan.front(), 0u);
  EXPECT_EQ(cloud.scan[9], 0u);
  EXPECT_EQ(cloud.scan[10], 2u);
  EXPECT_EQ(cloud.scan.back(), 2u);
  EXPECT_FLOAT_EQ(cloud.points.back().z(), 6.0f);
  EXPECT_EQ(cloud.normals.size(), 30u);
}

TEST(Cloud, MergedDropsAttributesThatAScanLacks) {
  std::vector<Scan> scans(2);
  scans[0].cloud = small_cloud(5);
  scans[1].cloud = small_cloud(5);
  scans[1].cloud.intensity.clear();
  const Cloud cloud = merged(scans);
  EXPECT_TRUE(cloud.intensity.empty());
  EXPECT_EQ(cloud.normals.size(), 10u);
}

}  // namespace
}  // namespace planum
