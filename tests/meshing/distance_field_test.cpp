#include "meshing/distance_field.hpp"

#include <random>

#include <gtest/gtest.h>

#include "scanned_scene.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Random points on a square with a normal, with noise across.
Cloud square(const Vector3d& corner, const Vector3d& u, const Vector3d& v, const Vector3d& normal,
             std::size_t count, double noise) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, 1);
  std::normal_distribution<double> across(0, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(
        (corner + place(random) * u + place(random) * v + noise * across(random) * normal)
            .cast<float>());
    cloud.normals.push_back(normal.cast<float>());
  }
  return cloud;
}

/// Calls visit(place, distance) for the corners that are known.
template <class Visit>
void for_known(const DistanceField& field, const Visit& visit) {
  for (std::size_t b = 0; b < field.blocks.size(); ++b)
    for (int c = 0; c < block_cells; ++c) {
      const float d = field.distance[b * block_cells + std::size_t(c)];
      if (std::isnan(d)) continue;
      const Eigen::Vector3i corner =
          cell_of(field.blocks.key(b)) +
          Eigen::Vector3i(c % block_width, c / block_width % block_width, c / 64);
      visit(field.lattice.origin + field.lattice.size * corner.cast<double>(), double(d));
    }
}

TEST(DistanceField, IsTheDistanceToAPlane) {
  const Vector3d normal = Vector3d(1, 2, 3).normalized();
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const Vector3d corner(0.3, -0.2, 0.7);
  const DistanceField field = distance_field(square(corner, 2 * u, 2 * v, normal, 40000, 0.0));
  std::size_t known = 0;
  for_known(field, [&](const Vector3d& p, double d) {
    ++known;
    EXPECT_NEAR(d, normal.dot(p - corner), 1e-4);
  });
  EXPECT_GT(known, 4000u);
}

TEST(DistanceField, AveragesNoiseAway) {
  const Cloud cloud = square({-1, -1, 0.013}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, 40000, 0.01);
  double sum = 0;
  std::size_t known = 0;
  for_known(distance_field(cloud), [&](const Vector3d& p, double d) {
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.9 || std::abs(p.z() - 0.013) > 0.05) return;
    sum += std::abs(d - (p.z() - 0.013));
    ++known;
  });
  EXPECT_LT(sum / double(known), 0.002);
}

TEST(DistanceField, KnowsOnlyWhatIsNearThePoints) {
  const Cloud cloud = square({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, 40000, 0.0);
  for_known(distance_field(cloud), [&](const Vector3d& p, double) {
    EXPECT_LT(std::abs(p.z()), 0.151);
    EXPECT_LT(p.head<2>().cwiseAbs().maxCoeff(), 1.16);
  });
}

TEST(DistanceField, GrowsWithSurfaceNotWithVolume) {
  const auto blocks_of = [](double size) {
    Cloud cloud = square({0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, 1},
                         std::size_t(8000 * size * size), 0.0);
    const Cloud top = square({0, 0, size}, {size, 0, 0}, {0, size, 0}, {0, 0, -1},
                             std::size_t(8000 * size * size), 0.0);
    cloud.points.insert(cloud.points.end(), top.points.begin(), top.points.end());
    cloud.normals.insert(cloud.normals.end(), top.normals.begin(), top.normals.end());
    return double(distance_field(cloud).blocks.size());
  };
  EXPECT_NEAR(blocks_of(6.4) / blocks_of(3.2), 4, 0.8);
}

TEST(DistanceField, IsNotStretchedByAFarOutlier) {
  Cloud cloud = square({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 1}, 40000, 0.0);
  const std::size_t blocks = distance_field(cloud).blocks.size();
  cloud.points.push_back({1e9f, 1e9f, -1e9f});
  cloud.normals.push_back({0, 0, 1});
  EXPECT_EQ(distance_field(cloud).blocks.size(), blocks);
}

TEST(DistanceField, KeepsTheSidesOfAThinWallApart) {
  // Two faces 10 cm apart that look away from each other: between them both are behind.
  Cloud cloud = square({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, {0, -1, 0}, 40000, 0.005);
  const Cloud back = square({-1, 0.1, -1}, {2, 0, 0}, {0, 0, 2}, {0, 1, 0}, 40000, 0.005);
  cloud.points.insert(cloud.points.end(), back.points.begin(), back.points.end());
  cloud.normals.insert(cloud.normals.end(), back.normals.begin(), back.normals.end());
  for_known(distance_field(cloud), [&](const Vector3d& p, double d) {
    if (std::abs(p.x()) > 0.9 || std::abs(p.z()) > 0.9) return;
    EXPECT_NEAR(d, std::abs(p.y() - 0.05) - 0.05, 0.006) << p.transpose();
  });
}

TEST(DistanceField, IsTheSameForAnyNumberOfThreads) {
  const Cloud cloud = square({-1, -1, 0}, {2, 0.3, 0}, {0, 2, 0.5}, {0, 0, 1}, 40000, 0.01);
  set_thread_count(1);
  const DistanceField one = distance_field(cloud);
  set_thread_count(4);
  const DistanceField four = distance_field(cloud);
  set_thread_count(0);
  ASSERT_EQ(one.distance.size(), four.distance.size());
  for (std::size_t i = 0; i < one.distance.size(); ++i)
    EXPECT_TRUE(one.distance[i] == four.distance[i] ||
                (std::isnan(one.distance[i]) && std::isnan(four.distance[i])));
  EXPECT_EQ(one.crossings, four.crossings);
}

}  // namespace
}  // namespace planum
