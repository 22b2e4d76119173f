#include "slam/core/plane.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

std::vector<Eigen::Vector3d> noisy_plane(const Pose& world_from_plane, double noise) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> extent(-1, 1);
  std::normal_distribution<double> off(0, noise);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 2000; ++i)
    points.push_back(world_from_plane *
                     Eigen::Vector3d(2 * extent(random), extent(random), off(random)));
  return points;
}

TEST(PlaneFit, RecoversAPlaneAnywhere) {
  for (int k = 0; k < 10; ++k) {
    const Pose pose = pose_from_xyz_ypr({1000.0 * k, -500, 20}, 0.3 * k, 0.2 * k, -0.4 * k);
    const auto fit = fit_plane(noisy_plane(pose, 0.01));
    ASSERT_TRUE(fit);
    const Eigen::Vector3d normal = pose.linear().col(2);
    EXPECT_LT(std::acos(std::min(1.0, std::abs(fit->plane.normal.dot(normal)))), radians(0.1));
    EXPECT_LT(std::abs(fit->plane.signed_distance(pose.translation())), 1e-3);
    EXPECT_NEAR(std::sqrt(fit->variances[0]), 0.01, 5e-4);
  }
}

TEST(PlaneFit, IsEmptyWhereThereIsNoPlane) {
  using P = Eigen::Vector3d;
  EXPECT_FALSE(fit_plane(std::vector<P>{}));
  EXPECT_FALSE(fit_plane(std::vector<P>{{1, 2, 3}, {2, 3, 4}}));
  EXPECT_FALSE(fit_plane(std::vector<P>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}}));
  EXPECT_FALSE(fit_plane(std::vector<P>(10, P(3, 3, 3))));
  EXPECT_TRUE(fit_plane(std::vector<P>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(PointMoments, OfTwoSetsAddUp) {
  const auto points = noisy_plane(Pose::Identity(), 0.1);
  PointMoments all, first, second;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.add(points[i]);
    (i < 700 ? first : second).add(points[i]);
  }
  first += second;
  EXPECT_LT((first.covariance() - all.covariance()).norm(), 1e-12);
  EXPECT_LT((first.centroid() - all.centroid()).norm(), 1e-12);
}

TEST(Plane, ProjectsOntoItself) {
  const Plane plane{.normal = Eigen::Vector3d(1, 2, 2) / 3, .offset = 4};
  const Eigen::Vector3d p(7, -3, 5), on_plane = plane.projected(p);
  EXPECT_NEAR(plane.signed_distance(on_plane), 0, 1e-12);
  EXPECT_NEAR((p - on_plane).cross(plane.normal).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace planum
