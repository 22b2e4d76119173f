#include "meshing/free_space.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scanned_scene.hpp"

namespace planum {
namespace {

/// A room of 8 m x 6 m x 2.6 m, seen from five places.
TriangleMesh room() {
  TriangleMesh model;
  testing::add_box(model, {8, 6, 2.6}, {0, 0, 0});  // seen from inside
  return model;
}

std::vector<Pose> five_places() {
  std::vector<Pose> poses;
  for (const auto& [x, y, yaw] : {std::tuple{1.0, 1.0, 0.6},
                                  {7.0, 1.2, 2.4},
                                  {6.8, 5.0, 3.9},
                                  {1.2, 4.8, -0.7},
                                  {4.0, 0.8, 1.6}})
    poses.push_back(pose_from_xyz_ypr({x, y, 1}, yaw, 0, 0));
  return poses;
}

std::size_t count(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
}

TEST(FreeSpace, SurfacesAreBelieved) {
  TriangleMesh model = room();
  testing::add_box(model, {3, 2, 0}, {4.4, 2.8, 0.75});      // a box
  testing::add_box(model, {5, 4, 0}, {5.04, 4.04, 2.6});     // a pole of 4 cm
  testing::add_box(model, {2, 3.5, 0.7}, {3.2, 4.3, 0.73});  // a table without legs
  const auto scene = testing::scanned(model, five_places());
  const auto free = in_free_space(scene.cloud, scene.origins);
  ASSERT_EQ(free.size(), scene.cloud.points.size());
  EXPECT_LT(count(free), scene.cloud.points.size() / 10000);
  std::size_t pole = 0, lost = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const Eigen::Vector3f& p = scene.cloud.points[i];
    if ((p.head<2>() - Eigen::Vector2f(5.02f, 4.02f)).norm() > 0.05f) continue;
    ++pole;
    lost += free[i];
  }
  EXPECT_GT(pole, 200u);
  EXPECT_LT(lost, pole / 50);
}

TEST(FreeSpace, WhatOnlyOneScanSawIsNot) {
  auto scene = testing::scanned(room(), five_places());
  const std::size_t real = scene.cloud.points.size();
  std::mt19937 random(3);
  std::uniform_real_distribution<float> off(-0.15f, 0.15f);
  for (int k = 0; k < 300; ++k) {  // somebody stood there during the second scan
    scene.cloud.points.emplace_back(4 + off(random), 3 + off(random), 1.2f + 3 * off(random));
    scene.cloud.scan.push_back(1);
  }
  const auto free = in_free_space(scene.cloud, scene.origins);
  EXPECT_GT(std::count(free.begin() + static_cast<std::ptrdiff_t>(real), free.end(), 1), 290);
  EXPECT_LT(std::count(free.begin(), free.begin() + static_cast<std::ptrdiff_t>(real), 1), 20);
}

TEST(FreeSpace, OneContradictionIsNotEnough) {
  auto poses = five_places();
  poses.resize(2);
  auto scene = testing::scanned(room(), poses);
  for (int k = 0; k < 50; ++k) {
    scene.cloud.points.emplace_back(4.0f, 3.0f, 1.0f + 0.005f * static_cast<float>(k));
    scene.cloud.scan.push_back(1);
  }
  EXPECT_EQ(count(in_free_space(scene.cloud, scene.origins)), 0u);
  EXPECT_EQ(count(in_free_space(scene.cloud, scene.origins, {.min_scans = 1})), 0u)
      << "twice as many as saw it";
}

TEST(FreeSpace, PosesThatAreALittleOffDoNotDeleteSurfaces) {
  // Each scan is turned by half a degree and moved by 3 cm before it is put into the cloud.
  const auto poses = five_places();
  TriangleMesh model = room();
  testing::add_box(model, {3, 2, 0}, {4.4, 2.8, 0.75});
  auto scene = testing::scanned(model, poses);
  std::mt19937 random(9);
  std::normal_distribution<double> off(0, 1);
  std::vector<Pose> errors;
  for (std::size_t s = 0; s < poses.size(); ++s)
    errors.push_back(pose_from_xyz_ypr({0.03 * off(random), 0.03 * off(random), 0.03 * off(random)},
                                       radians(0.5) * off(random), radians(0.5) * off(random),
                                       radians(0.5) * off(random)));
  for (std::size_t i = 0; i < scene.cloud.points.size(); ++i) {
    const std::uint32_t s = scene.cloud.scan[i];
    const Pose moved = poses[s] * errors[s] * poses[s].inverse();
    scene.cloud.points[i] = (moved * scene.cloud.points[i].cast<double>()).cast<float>();
    scene.cloud.normals.push_back((moved.linear() * scene.normals[i].cast<double>()).cast<float>());
  }
  EXPECT_LT(count(in_free_space(scene.cloud, scene.origins)), scene.cloud.points.size() / 2000);
}

TEST(FreeSpace, SparseScansSayLess) {
  // Slices six degrees apart: between them nothing is known to be free.
  testing::ScannerParams sparse;
  sparse.slices = 21;
  TriangleMesh model = room();
  testing::add_box(model, {3, 2, 1.0}, {4.4, 2.8, 1.05});
  const auto scene = testing::scanned(model, five_places(), sparse);
  EXPECT_LT(count(in_free_space(scene.cloud, scene.origins)), scene.cloud.points.size() / 1000);
}

TEST(FreeSpace, IsTheSameForAnyNumberOfThreads) {
  auto scene = testing::scanned(room(), five_places());
  scene.cloud.points.emplace_back(4.0f, 3.0f, 1.0f);
  scene.cloud.scan.push_back(0);
  const auto with = [&](int threads) {
    set_thread_count(threads);
    const auto free = in_free_space(scene.cloud, scene.origins);
    set_thread_count(0);
    return free;
  };
  EXPECT_EQ(with(1), with(5));
}

TEST(FreeSpace, TakesLittleAndRefusesNonsense) {
  EXPECT_TRUE(in_free_space({}, {}).empty());
  Cloud one;
  one.points.emplace_back(1, 2, 3);
  const std::vector<Eigen::Vector3d> origins = {{0, 0, 0}};
  EXPECT_EQ(count(in_free_space(one, origins)), 0u);
  one.scan = {2};
  EXPECT_THROW(in_free_space(one, origins), Error);
  one.scan = {0, 0};
  EXPECT_THROW(in_free_space(one, origins), Error);
  one.scan = {0};
  EXPECT_THROW(in_free_space(one, origins, {.cell = 0}), Error);
  EXPECT_THROW(in_free_space(one, origins, {.min_scans = -1}), Error);
  EXPECT_THROW(in_free_space(one, origins, {.margin_per_metre = -1}), Error);
  EXPECT_THROW(in_free_space(one, origins, {.max_tilt = 2}), Error);
  one.points[0].x() = std::nanf("");
  EXPECT_THROW(in_free_space(one, origins), Error);
}

}  // namespace
}  // namespace planum
