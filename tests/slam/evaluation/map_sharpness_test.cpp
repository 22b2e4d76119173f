#include "slam/evaluation/map_sharpness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

/// A square of 2 m with noise across it.
std::vector<Eigen::Vector3f> noisy_square(std::size_t count, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-1, 1);
  std::normal_distribution<float> off(0, 1);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(place(random), place(random), static_cast<float>(noise) * off(random));
  return points;
}

/// Equations of the page in docs, without a tree.
MapSharpness brute_force(const std::vector<Eigen::Vector3f>& points,
                         const MapSharpnessParams& params) {
  MapSharpness result;
  std::vector<double> thicknesses;
  for (const auto& query : points) {
    std::vector<Eigen::Vector3d> near;
    for (const auto& p : points)
      if ((p - query).squaredNorm() <= params.radius * params.radius)
        near.push_back(p.cast<double>());
    if (near.size() < params.min_neighbours) {
      ++result.passed_over;
      continue;
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : near) mean += p / static_cast<double>(near.size());
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& p : near)
      covariance += (p - mean) * (p - mean).transpose() / static_cast<double>(near.size());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    ++result.measured;
    result.mean_entropy += 0.5 * std::log((2 * pi * std::exp(1.0) * covariance).determinant());
    result.mean_plane_variance += solver.eigenvalues()[0];
    thicknesses.push_back(std::sqrt(solver.eigenvalues()[0]));
  }
  result.mean_entropy /= static_cast<double>(result.measured);
  result.mean_plane_variance /= static_cast<double>(result.measured);
  std::sort(thicknesses.begin(), thicknesses.end());
  result.plane_thickness =
      (thicknesses[(thicknesses.size() - 1) / 2] + thicknesses[thicknesses.size() / 2]) / 2;
  return result;
}

TEST(MapSharpness, IsThatOfBruteForce) {
  const auto points = noisy_square(1500, 0.02, 1);
  const MapSharpnessParams params{.radius = 0.15, .min_neighbours = 8};
  const MapSharpness found = map_sharpness(points, params), expected = brute_force(points, params);
  EXPECT_EQ(found.measured, expected.measured);
  EXPECT_EQ(found.passed_over, expected.passed_over);
  EXPECT_NEAR(found.mean_entropy, expected.mean_entropy, 1e-6);
  EXPECT_NEAR(found.mean_plane_variance, expected.mean_plane_variance, 1e-10);
  EXPECT_NEAR(found.plane_thickness, expected.plane_thickness, 1e-8);
}

TEST(MapSharpness, MeasuresTheNoiseOfAPlane) {
  const auto points = noisy_square(40000, 0.01, 2);
  const MapSharpness found = map_sharpness(points, {.max_queries = 3000});
  EXPECT_NEAR(found.plane_thickness, 0.01, 0.0003);
  EXPECT_NEAR(found.mean_plane_variance, 1e-4, 5e-6);
  EXPECT_EQ(found.measured + found.passed_over, 3000u);
}

TEST(MapSharpness, SeesADoubledWall) {
  auto points = noisy_square(20000, 0.005, 3);
  const MapSharpness one = map_sharpness(points, {.max_queries = 1000});
  for (Eigen::Vector3f p : noisy_square(20000, 0.005, 4))
    points.push_back(p + Eigen::Vector3f(0, 0, 0.04f));
  const MapSharpness two = map_sharpness(points, {.max_queries = 1000});
  // Halves d apart have a variance of d^2 / 4 beside their own.
  EXPECT_NEAR(two.plane_thickness, std::hypot(0.02, 0.005), 0.001);
  EXPECT_GT(two.mean_entropy, one.mean_entropy + 1);
}

TEST(MapSharpness, DoesNotChangeWhenEverythingIsMoved) {
  const auto points = noisy_square(3000, 0.01, 5);
  const Eigen::Isometry3f moved = pose_from_xyz_ypr({20, -30, 5}, 0.7, 0.4, -1.2).cast<float>();
  std::vector<Eigen::Vector3f> elsewhere;
  for (const auto& p : points) elsewhere.push_back(moved * p);
  const MapSharpness here = map_sharpness(points), there = map_sharpness(elsewhere);
  EXPECT_NEAR(here.mean_entropy, there.mean_entropy, 1e-3);
  EXPECT_NEAR(here.plane_thickness, there.plane_thickness, 1e-5);
}

TEST(MapSharpness, IsTheSameForAnyNumberOfThreads) {
  const auto points = noisy_square(5000, 0.01, 6);
  set_thread_count(1);
  const MapSharpness one = map_sharpness(points, {.max_points = 4000, .max_queries = 700});
  set_thread_count(4);
  const MapSharpness many = map_sharpness(points, {.max_points = 4000, .max_queries = 700});
  set_thread_count(0);
  EXPECT_EQ(one.mean_entropy, many.mean_entropy);
  EXPECT_EQ(one.mean_plane_variance, many.mean_plane_variance);
  EXPECT_EQ(one.plane_thickness, many.plane_thickness);
}

TEST(MapSharpness, CountsNothingAsThinnerThanItMay) {
  const auto points = noisy_square(2000, 0, 7);
  const MapSharpness found = map_sharpness(points, {.least_deviation = 1e-3});
  EXPECT_DOUBLE_EQ(found.plane_thickness, 1e-3);
  EXPECT_TRUE(std::isfinite(found.mean_entropy));
}

TEST(MapSharpness, IsZeroWhereNothingCanBeMeasured) {
  const std::vector<Eigen::Vector3f> apart = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}};
  EXPECT_EQ(map_sharpness(apart).measured, 0u);
  EXPECT_EQ(map_sharpness(apart).passed_over, 3u);
  EXPECT_EQ(map_sharpness({}).mean_entropy, 0);
}

TEST(MapSharpness, SaysWhatIsWrong) {
  const auto points = noisy_square(100, 0.01, 8);
  EXPECT_THROW(map_sharpness(points, {.radius = 0}), Error);
  EXPECT_THROW(map_sharpness(points, {.min_neighbours = 2}), Error);
  EXPECT_THROW(map_sharpness(points, {.least_deviation = 0}), Error);
  std::vector<Eigen::Vector3f> broken = points;
  broken[3].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(map_sharpness(broken), Error);
}

}  // namespace
}  // namespace planum
