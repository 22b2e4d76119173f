#include "meshing/loose_parts.hpp"

#include <gtest/gtest.h>

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

TEST(LooseParts, SpecksGoAndTheRestStaysAsItWas) {
  const TriangleMesh mesh = without_loose_parts(speck_before_wall(), 0.01);
  ASSERT_EQ(mesh.vertices.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(LooseParts, PartsJoinedByAVertexAreOne) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.01f, 0, 0}, {0, -0.01f, 0}};
  mesh.triangles = {{0, 3, 4}, {0, 1, 2}};
  EXPECT_EQ(without_loose_parts(mesh, 0.1).triangles, mesh.triangles);
}

TEST(LooseParts, NothingIsLostWithoutALimit) {
  const TriangleMesh mesh = speck_before_wall(), all = without_loose_parts(mesh, 0);
  EXPECT_EQ(all.triangles, mesh.triangles);
  EXPECT_EQ(all.vertices.size(), mesh.vertices.size() - 1);
  EXPECT_TRUE(without_loose_parts(mesh, 2).triangles.empty());
  EXPECT_TRUE(without_loose_parts({}, 1).triangles.empty());
}

}  // namespace
}  // namespace planum
