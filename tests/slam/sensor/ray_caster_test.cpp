#include "slam/sensor/ray_caster.hpp"

#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

struct RandomScene {
  std::mt19937 random{5};
  std::uniform_real_distribution<double> unit{-1, 1};

  Eigen::Vector3d vector() { return {unit(random), unit(random), unit(random)}; }

  TriangleMesh mesh(std::uint32_t triangles) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const Eigen::Vector3d centre = 3 * vector();
      for (int corner = 0; corner < 3; ++corner)
        mesh.vertices.push_back((centre + vector()).cast<float>());
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
  }
};

/// Distance along the ray to one triangle, by solving for it; infinite if it misses.
double distance_to(const TriangleMesh& mesh, std::size_t triangle, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
  Eigen::Matrix3d m;
  m << mesh.vertices[b].cast<double>() - p, mesh.vertices[c].cast<double>() - p, -direction;
  const Eigen::Vector3d uvt = m.inverse() * (origin - p);
  const bool inside = uvt.x() >= 0 && uvt.y() >= 0 && uvt.x() + uvt.y() <= 1 && uvt.z() > 0;
  return inside ? uvt.z() : std::numeric_limits<double>::infinity();
}

TEST(RayCaster, FindsWhatBruteForceFinds) {
  RandomScene scene;
  const TriangleMesh mesh = scene.mesh(200);
  const RayCaster caster(mesh);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d origin = 3 * scene.vector(), direction = scene.vector().normalized();
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      nearest = std::min(nearest, distance_to(mesh, t, origin, direction));
    const auto hit = caster.cast(origin, direction, 4);
    if (std::abs(nearest - 4) < 1e-3) continue;
    ASSERT_EQ(hit.has_value(), nearest < 4);
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, nearest, 1e-4);
    EXPECT_NEAR(distance_to(mesh, hit->triangle, origin, direction), nearest, 1e-4);
  }
  EXPECT_GT(hits, 500);
}

TEST(RayCaster, NormalLooksOutOfTheCounterClockwiseSide) {
  const TriangleMesh mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}};
  const RayCaster caster(mesh);
  for (const double side : {-1.0, 1.0}) {
    const auto hit = caster.cast({0.2, 0.2, 2 * side}, {0, 0, -side}, 10);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->normal, Eigen::Vector3f(0, 0, 1));
    EXPECT_FLOAT_EQ(static_cast<float>(hit->distance), 2);
  }
}

TEST(RayCaster, NothingIsHitInAnEmptyModel) {
  EXPECT_FALSE(RayCaster(TriangleMesh{}).cast({0, 0, 0}, {1, 0, 0}, 100));
}

TEST(RayCaster, RefusesBrokenModels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(message_of([&] {
              RayCaster({.vertices = {{0, nan, 0}}, .triangles = {}});
            }),
            "vertex 0 of the model is not finite");
  EXPECT_EQ(message_of([] {
              RayCaster({.vertices = {{0, 0, 0}, {1, 0, 0}}, .triangles = {{0, 1, 2}}});
            }),
            "triangle 0 of the model uses vertex 2 of 2");
}

}  // namespace
}  // namespace planum
