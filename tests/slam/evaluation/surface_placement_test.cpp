#include "slam/evaluation/surface_placement.hpp"

#include <random>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/sampling.hpp"

namespace planum {
namespace {

void add_box(TriangleMesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const float z : {low.z(), high.z()})
    for (const float y : {low.y(), high.y()})
      for (const float x : {low.x(), high.x()}) mesh.vertices.emplace_back(x, y, z);
  for (const auto& [a, b, c] : {std::array<std::uint32_t, 3>{0, 1, 3},
                                {0, 3, 2},
                                {4, 7, 5},
                                {4, 6, 7},
                                {0, 5, 1},
                                {0, 4, 5},
                                {2, 3, 7},
                                {2, 7, 6},
                                {0, 2, 6},
                                {0, 6, 4},
                                {1, 5, 7},
                                {1, 7, 3}})
    mesh.triangles.push_back({first + a, first + b, first + c});
}

/// Two rooms of different size and a cupboard, so that only one place suits.
TriangleMesh two_rooms() {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {6, 4, 2.6f});
  add_box(mesh, {6.1f, 0, 0}, {9, 3, 2.6f});
  add_box(mesh, {0.5f, 0, 0}, {1.7f, 0.6f, 2});
  return mesh;
}

/// Points of the larger room.
Cloud seen_part(std::uint64_t count) {
  const TriangleMesh mesh = two_rooms();
  const SurfaceTree surface(mesh);
  const SurfaceSamples samples = surface_samples(mesh, count);
  Cloud cloud;
  for (std::size_t k = 0; k < samples.points.size(); ++k) {
    if (samples.points[k].x() > 6.05) continue;
    cloud.points.push_back(samples.points[k].cast<float>());
    cloud.normals.push_back(surface.normal(samples.triangles[k]).cast<float>());
  }
  return cloud;
}

TEST(PlaceOnSurface, FindsTheOnePlaceThatSuitsFromAnywhere) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  const TriangleMesh mesh = two_rooms();
  const SurfaceTree surface(mesh);
  const Cloud part = seen_part(8000);
  for (int draw = 0; draw < 3; ++draw) {
    const Pose motion = pose_from_xyz_ypr(
        30 * Eigen::Vector3d(any(random), any(random), any(random)), pi * any(random), 0, 0);
    const SurfaceFit fit = place_on_surface(transformed(part, motion.inverse()), mesh, surface,
                                            {.points = 200, .fit_points = 3000, .refined = 6});
    EXPECT_TRUE(fit.converged);
    const Pose error = fit.surface_from_points.inverse() * motion;
    EXPECT_LT(error.translation().norm(), 0.002);
    EXPECT_LT(degrees(rotation_angle(error)), 0.02);
  }
}

TEST(PlaceOnSurface, SaysWhatIsWrong) {
  const TriangleMesh mesh = two_rooms();
  const SurfaceTree surface(mesh);
  Cloud bare = seen_part(1000);
  bare.normals.clear();
  EXPECT_THROW(place_on_surface(bare, mesh, surface), Error);
  EXPECT_THROW(place_on_surface({}, mesh, surface), Error);
  EXPECT_THROW(place_on_surface(seen_part(1000), mesh, surface, {.step = 0}), Error);
}

}  // namespace
}  // namespace planum
