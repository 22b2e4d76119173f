#include "meshing/loose_parts.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scanned_scene.hpp"

namespace planum {
namespace {

TriangleMesh speck_before_wall() {
  TriangleMesh mesh;
  testing::add_rectangle(mesh, {5, 5, 5}, {0.05, 0, 0}, {0, 0.05, 0});  // 25 cm^2
  testing::add_rectangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.vertices.emplace_back(9, 9, 9);  // of no triangle
  return mesh;
}

/// A square of triangles of 5 cm.
void add_sheet(TriangleMesh& mesh, const Eigen::Vector3d& corner, double side) {
  for (double x = 0; x < side - 0.01; x += 0.05)
    for (double y = 0; y < side - 0.01; y += 0.05)
      testing::add_rectangle(mesh, corner + Eigen::Vector3d(x, y, 0), {0.05, 0, 0}, {0, 0.05, 0});
  // Corners at one place are one vertex.
  std::map<std::array<float, 3>, std::uint32_t> known;
  TriangleMesh joined;
  for (auto t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const Eigen::Vector3f& p = mesh.vertices[v];
      const auto place = known.emplace(std::array{p.x(), p.y(), p.z()}, joined.vertices.size());
      if (place.second) joined.vertices.push_back(p);
      v = place.first->second;
    }
    joined.triangles.push_back(t);
  }
  mesh = joined;
}

/// `count` points on a square.
void add_points(Cloud& cloud, const Eigen::Vector3d& corner, double side, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(0, side);
  for (int i = 0; i < count; ++i) {
    cloud.points.push_back(
        (corner + Eigen::Vector3d(along(random), along(random), 0)).cast<float>());
    cloud.normals.push_back(Eigen::Vector3f::UnitZ());
  }
}

constexpr LoosePartParams by_density{.min_area = 0, .sure_area = 0.1, .min_density = 400};

TEST(LooseParts, SpecksGoAndTheRestStaysAsItWas) {
  const TriangleMesh mesh = without_loose_parts(speck_before_wall(), {}, {.min_area = 0.01});
  ASSERT_EQ(mesh.vertices.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(LooseParts, PartsJoinedByAVertexAreOne) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.01f, 0, 0}, {0, -0.01f, 0}};
  mesh.triangles = {{0, 3, 4}, {0, 1, 2}};
  EXPECT_EQ(without_loose_parts(mesh, {}, {.min_area = 0.1}).triangles, mesh.triangles);
}

TEST(LooseParts, NothingIsLostWithoutALimit) {
  const TriangleMesh mesh = speck_before_wall(), all = without_loose_parts(mesh, {}, {});
  EXPECT_EQ(all.triangles, mesh.triangles);
  EXPECT_EQ(all.vertices.size(), mesh.vertices.size() - 1);
  EXPECT_TRUE(without_loose_parts(mesh, {}, {.min_area = 2}).triangles.empty());
  EXPECT_TRUE(without_loose_parts({}, {}, {.min_area = 1}).triangles.empty());
}

TEST(LooseParts, AVeilOfFewPointsGoesAndASheetOfManyStays) {
  const Eigen::Vector3d veil(0, 0, 0), sheet(1, 0, 0), far(3, 0, 0);
  TriangleMesh mesh;
  for (const Eigen::Vector3d& corner : {veil, sheet, far}) add_sheet(mesh, corner, 0.2);
  add_sheet(mesh, {0, 3, 0}, 0.4);  // large enough to be believed, whatever was seen of it
  Cloud cloud;
  add_points(cloud, veil, 0.2, 12);    // 300 on a square metre
  add_points(cloud, sheet, 0.2, 400);  // 10,000 on a square metre
  add_points(cloud, far, 0.2, 400);
  for (std::size_t i = 412; i < cloud.normals.size(); ++i) cloud.normals[i].setZero();
  const TriangleMesh kept = without_loose_parts(mesh, cloud, by_density);
  EXPECT_EQ(kept.triangles.size(), 2u * (16 + 64));
  for (const Eigen::Vector3f& v : kept.vertices)
    EXPECT_TRUE(v.y() >= 3 || v.x() == std::clamp(v.x(), 1.0f, 1.21f));
}

TEST(LooseParts, AreTheSameForAnyNumberOfThreads) {
  TriangleMesh mesh;
  Cloud cloud;
  for (int k = 0; k < 20; ++k) {
    add_sheet(mesh, Eigen::Vector3d(k, 0, 0), 0.2);
    add_points(cloud, Eigen::Vector3d(k, 0, 0), 0.2, 4 * k);
  }
  set_thread_count(1);
  const TriangleMesh one = without_loose_parts(mesh, cloud, by_density);
  set_thread_count(4);
  const TriangleMesh four = without_loose_parts(mesh, cloud, by_density);
  set_thread_count(0);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_GT(one.triangles.size(), 0u);
  EXPECT_LT(one.triangles.size(), mesh.triangles.size());
}

TEST(LooseParts, RefusePointsWithoutNormals) {
  Cloud cloud;
  cloud.points.emplace_back(0, 0, 0);
  EXPECT_THROW(without_loose_parts(speck_before_wall(), cloud, {}), Error);
}

}  // namespace
}  // namespace planum
