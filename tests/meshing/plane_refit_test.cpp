#include "meshing/plane_refit.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scenes.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;

/// Points on the sides of a box room with noise along the normal and some outliers.
Cloud points_of_box_room(const Vector3d& size, std::size_t count, double noise, double outliers,
                         unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> gauss(0, noise);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const auto side = static_cast<int>(random() % 6);
    const int axis = side / 2;
    Vector3d p(share(random) * size.x(), share(random) * size.y(), share(random) * size.z());
    Vector3d n = Vector3d::Zero();
    n[axis] = side % 2 ? -1 : 1;
    // Outliers lie before the wall, as mixed pixels do.
    const double off = share(random) < outliers ? 0.2 * share(random) : gauss(random);
    p[axis] = (side % 2 ? size[axis] : 0) + off * n[axis];
    cloud.points.push_back(p.cast<float>());
    cloud.normals.push_back((n + 0.05 * Vector3d::Random()).normalized().cast<float>());
  }
  return cloud;
}

/// Largest distance (m) of a region's plane from the side of the box it stands for, over that side.
double worst_error(const Regions& regions, const Vector3d& size) {
  double worst = 0;
  for (const Region& region : regions.regions) {
    int axis;
    region.plane.normal.cwiseAbs().maxCoeff(&axis);
    for (int corner = 0; corner < 4; ++corner) {
      Vector3d p;
      p[(axis + 1) % 3] = (corner & 1) * size[(axis + 1) % 3];
      p[(axis + 2) % 3] = (corner >> 1) * size[(axis + 2) % 3];
      p[axis] = region.plane.normal[axis] > 0 ? 0 : size[axis];
      worst = std::max(worst, std::abs(region.plane.signed_distance(p)));
    }
  }
  return worst;
}

TEST(RefitPlanes, AreFarBetterThanThoseOfTheMesh) {
  const Vector3d size(4.03, 3.11, 2.52);
  TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
  for (Eigen::Vector3f& v : mesh.vertices) v += Eigen::Vector3f(0.011f, -0.008f, 0.009f);
  testing::add_noise(mesh, 0.005, 3);
  const Regions rough = grow_planes(mesh, region_params(0.1));
  ASSERT_EQ(rough.regions.size(), 6u);
  EXPECT_GT(worst_error(rough, size), 0.008);
  const Cloud cloud = points_of_box_room(size, 60'000, 0.01, 0.05, 4);
  const Regions fine = refit_planes(rough, mesh, cloud);
  EXPECT_LT(worst_error(fine, size), 0.001);
  EXPECT_EQ(fine.of_triangle, rough.of_triangle);
}

TEST(RefitPlanes, KeepTheSidesOfAThinWallApart) {
  // Two rooms with a wall of 6 cm: nearer than the points are looked for.
  const testing::Field field = [](const Vector3d& p) {
    return std::max(testing::inside_box(p, {0, 0, 0}, {2, 2, 2}),
                    testing::inside_box(p, {2.06, 0, 0}, {4, 2, 2}));
  };
  const TriangleMesh mesh = testing::MarchingTetrahedra::surface(field, Vector3d::Constant(-0.11),
                                                                 Vector3d(4.1, 2.1, 2.1), 0.02);
  const Regions regions = grow_planes(mesh, region_params(0.02));
  Cloud cloud;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(0.1f, 1.9f);
  std::normal_distribution<float> noise(0, 0.01f);
  for (int i = 0; i < 20'000; ++i) {
    const bool right = i % 2;
    cloud.points.emplace_back((right ? 2.06f : 2.f) + noise(random), place(random), place(random));
    cloud.normals.emplace_back(right ? 1.f : -1.f, 0.f, 0.f);
  }
  const Regions fine = refit_planes(regions, mesh, cloud, {.max_distance = 0.05});
  int found = 0;
  for (const Region& region : fine.regions) {
    const double x = region.plane.offset * region.plane.normal.x();
    if (std::abs(region.plane.normal.x()) < 0.9 || x < 1 || x > 3) continue;
    ++found;
    EXPECT_NEAR(x, region.plane.normal.x() > 0 ? 2.06 : 2.0, 0.001);
  }
  EXPECT_EQ(found, 2);
}

TEST(RefitPlanes, NeedNoNormalsWherePlanesDoNotMeet) {
  const Vector3d size(4, 3, 2.5);
  const TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
  Cloud cloud = points_of_box_room(size, 60'000, 0.01, 0, 6);
  cloud.normals.clear();
  const Regions fine = refit_planes(grow_planes(mesh, region_params(0.1)), mesh, cloud);
  EXPECT_LT(worst_error(fine, size), 0.002);
}

TEST(RefitPlanes, WithFewPointsStayAsTheyAre) {
  const Vector3d size(4, 3, 2.5);
  const TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
  const Regions rough = grow_planes(mesh, region_params(0.1));
  const Regions fine = refit_planes(rough, mesh, points_of_box_room(size, 100, 0.01, 0, 7));
  for (std::size_t i = 0; i < rough.regions.size(); ++i)
    EXPECT_EQ(fine.regions[i].plane.offset, rough.regions[i].plane.offset);
}

TEST(RefitPlanes, AreTheSameForAnyNumberOfThreads) {
  const Vector3d size(4, 3, 2.5);
  const TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
  const Regions rough = grow_planes(mesh, region_params(0.1));
  const Cloud cloud = points_of_box_room(size, 50'000, 0.01, 0.03, 8);
  set_thread_count(1);
  const Regions one = refit_planes(rough, mesh, cloud);
  set_thread_count(3);
  const Regions three = refit_planes(rough, mesh, cloud);
  set_thread_count(0);
  for (std::size_t i = 0; i < one.regions.size(); ++i) {
    EXPECT_EQ(one.regions[i].plane.normal, three.regions[i].plane.normal);
    EXPECT_EQ(one.regions[i].plane.offset, three.regions[i].plane.offset);
  }
}

TEST(RefitPlanes, RefuseWhatDoesNotBelongTogether) {
  const TriangleMesh mesh = testing::box_room_mesh({2, 2, 2}, 0.2);
  const Regions regions = grow_planes(mesh, region_params(0.2));
  Cloud cloud;
  cloud.points.assign(5, Eigen::Vector3f(0, 0, NAN));
  EXPECT_THROW(refit_planes(regions, mesh, cloud), Error);
  EXPECT_THROW(refit_planes(regions, {}, {}), Error);
  EXPECT_THROW(refit_planes(regions, mesh, {}, {.max_distance = 0}), Error);
}

}  // namespace
}  // namespace planum
