#include "slam/evaluation/surface_comparison.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/sampling.hpp"
#include "tests/support/surface_distance.hpp"

namespace planum {
namespace {

TriangleMesh random_mesh(std::size_t triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(0, 5), side(-0.5, 0.5);
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Eigen::Vector3f corner(place(random), place(random), place(random));
    mesh.vertices.push_back(corner);
    for (int k = 0; k < 2; ++k)
      mesh.vertices.push_back(corner + Eigen::Vector3f(side(random), side(random), side(random)));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

/// A box of 4 x 3 x 2.5 m, open to none of its sides.
TriangleMesh box() {
  TriangleMesh mesh;
  for (const float z : {0.f, 2.5f})
    for (const float y : {0.f, 3.f})
      for (const float x : {0.f, 4.f}) mesh.vertices.emplace_back(x, y, z);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

TEST(SurfaceTree, FindsTheNearestPointOfBruteForce) {
  for (const std::size_t triangles : {1u, 4u, 5u, 300u}) {
    const TriangleMesh mesh = random_mesh(triangles, 1);
    const SurfaceTree tree(mesh);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-1, 6);
    for (int k = 0; k < 300; ++k) {
      const Eigen::Vector3d query(place(random), place(random), place(random));
      double least = std::numeric_limits<double>::infinity();
      for (const auto& [a, b, c] : mesh.triangles)
        least =
            std::min(least, (testing::nearest_in_triangle(query, mesh.vertices[a].cast<double>(),
                                                          mesh.vertices[b].cast<double>(),
                                                          mesh.vertices[c].cast<double>()) -
                             query)
                                .norm());
      const auto found = tree.nearest(query);
      ASSERT_TRUE(found.has_value());
      EXPECT_NEAR(found->distance, least, 1e-9);
      EXPECT_NEAR((found->point - query).norm(), least, 1e-9);
      EXPECT_FALSE(tree.nearest(query, 0.99 * least).has_value());
      EXPECT_TRUE(tree.nearest(query, 1.01 * least).has_value());
    }
  }
}

TEST(SurfaceTree, SaysWhatIsWrong) {
  EXPECT_THROW(SurfaceTree(TriangleMesh{}), Error);
  TriangleMesh mesh = box();
  mesh.triangles[0][1] = 8;
  EXPECT_THROW(SurfaceTree{mesh}, Error);
  mesh = box();
  mesh.vertices[2].x() = NAN;
  EXPECT_THROW(SurfaceTree{mesh}, Error);
}

TEST(SurfaceDistances, AreThoseThatWerePutIn) {
  const SurfaceTree tree(box());
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 100; ++i) points.emplace_back(2, 1.5, 0.001 * i);
  const SurfaceDistances found = surface_distances(points, tree, 0.02);
  EXPECT_EQ(found.count, 100u);
  EXPECT_NEAR(found.mean, 0.0495, 1e-9);
  EXPECT_NEAR(found.median, 0.0495, 1e-9);
  EXPECT_NEAR(found.max, 0.099, 1e-9);
  EXPECT_NEAR(found.percentile_90, 0.0891, 1e-9);
  EXPECT_NEAR(found.rms, std::sqrt(0.00328350), 1e-9);
  // 0 to 20 mm; the last may fall on either side by rounding.
  EXPECT_NEAR(found.share_within, 0.205, 0.006);
  EXPECT_EQ(surface_distances({}, tree).count, 0u);
  EXPECT_THROW(surface_distances(points, tree, -1), Error);
}

TEST(SurfaceSamples, LieOnTheSurfaceEvenly) {
  const TriangleMesh mesh = box();
  const SurfaceSamples samples = surface_samples(mesh, 59000);
  ASSERT_EQ(samples.points.size(), 59000u);
  EXPECT_LT(surface_distances(samples.points, SurfaceTree(mesh)).max, 1e-6);
  // 12 of 59 m^2 are floor.
  std::size_t on_floor = 0, on_its_half = 0;
  for (const Eigen::Vector3d& p : samples.points) {
    if (p.z() > 1e-6) continue;
    ++on_floor;
    if (p.x() < 2) ++on_its_half;
  }
  EXPECT_NEAR(static_cast<double>(on_floor), 12000, 10);
  EXPECT_NEAR(static_cast<double>(on_its_half), 6000, 200);
  EXPECT_TRUE(surface_samples({}, 100).points.empty());
}

TEST(EvenlyChosen, TakesOneOfEachPart) {
  for (const auto& [count, wanted] : {std::pair(1000u, 10u), std::pair(1001u, 250u)}) {
    const auto chosen = evenly_chosen(count, wanted);
    ASSERT_EQ(chosen.size(), wanted);
    for (std::size_t k = 0; k < wanted; ++k) {
      EXPECT_GE(chosen[k], count * k / wanted);
      EXPECT_LT(chosen[k], count * (k + 1) / wanted);
    }
  }
  EXPECT_EQ(evenly_chosen(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(evenly_chosen(3, 0), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(evenly_chosen(0, 5).empty());
}

TEST(FitToSurface, RecoversAMotion) {
  const SurfaceTree tree(box());
  std::vector<Eigen::Vector3d> points = surface_samples(box(), 3000).points;
  const Pose motion = pose_from_xyz_ypr({0.2, -0.15, 0.1}, radians(4), radians(-2), radians(1));
  for (Eigen::Vector3d& p : points) p = motion.inverse() * p;
  for (int i = 0; i < 300; ++i) points.emplace_back(0.01 * i, 1.5, 1.2);  // what the model lacks
  const SurfaceFit fit = fit_to_surface(points, tree, Pose::Identity());
  EXPECT_TRUE(fit.converged);
  EXPECT_LT((fit.surface_from_points.matrix() - motion.matrix()).cwiseAbs().maxCoeff(), 3e-4);
  EXPECT_LT(fit.rms, 0.01);
}

TEST(FitToSurface, LeavesWhatIsOpenAsGuessed) {
  TriangleMesh floor;
  floor.vertices = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  floor.triangles = {{0, 1, 2}, {0, 2, 3}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-2, 2);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(place(random), place(random), 0);
  const Pose guess = pose_from_xyz_ypr({1, 2, 0.1}, 0.5, 0, 0);
  const Pose found = fit_to_surface(points, SurfaceTree(floor), guess).surface_from_points;
  EXPECT_NEAR(found.translation().x(), 1, 1e-6);
  EXPECT_NEAR(found.translation().y(), 2, 1e-6);
  EXPECT_NEAR(found.translation().z(), 0, 1e-6);
  EXPECT_NEAR(rotation_angle(found, guess), 0, 1e-6);
}

TEST(FitToSurface, SaysWhatIsWrong) {
  const SurfaceTree tree(box());
  const std::vector<Eigen::Vector3d> far = {{50, 0, 0}};
  EXPECT_THROW(fit_to_surface(far, tree, Pose::Identity()), Error);
  const std::vector<Eigen::Vector3d> near = surface_samples(box(), 20).points;
  EXPECT_THROW(fit_to_surface(near, tree, Pose::Identity(), {.last_gate = 0}), Error);
  EXPECT_THROW(fit_to_surface(near, tree, Pose::Identity(), {.first_gate = 0.01}), Error);
  EXPECT_THROW(fit_to_surface(near, tree, Pose::Identity(), {.max_iterations = 0}), Error);
  Pose broken = Pose::Identity();
  broken.translation().x() = NAN;
  EXPECT_THROW(fit_to_surface(near, tree, broken), Error);
}

}  // namespace
}  // namespace planum
