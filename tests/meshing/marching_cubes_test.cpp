#include "meshing/marching_cubes.hpp"

#include <functional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "meshing/cell_loops.hpp"
#include "scanned_scene.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using testing::Topology;
using testing::topology_of;

/// A field known in a cube of blocks around the origin.
DistanceField sampled(const std::function<double(const Vector3d&)>& distance, double cell,
                      int blocks) {
  DistanceField field;
  field.lattice.size = cell;
  std::vector<CellKey> keys;
  for (int z = -blocks; z < blocks; ++z)
    for (int y = -blocks; y < blocks; ++y)
      for (int x = -blocks; x < blocks; ++x)
        keys.push_back(cell_key(x * block_width, y * block_width, z * block_width));
  field.blocks = BlockSet(keys);
  for (std::size_t b = 0; b < field.blocks.size(); ++b)
    for (int c = 0; c < block_cells; ++c) {
      const Eigen::Vector3i corner =
          cell_of(field.blocks.key(b)) +
          Eigen::Vector3i(c % block_width, c / block_width % block_width, c / 64);
      field.distance.push_back(float(distance(cell * corner.cast<double>())));
      field.crossings.push_back(7 * crossing_near_data);
    }
  return field;
}

/// Corner values that are random inside a box and positive at its rim, so that the surface is
/// closed.
DistanceField random_field(unsigned seed, int blocks) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  const double rim = blocks * block_width - 1.5;
  return sampled(
      [&](const Vector3d& p) { return p.cwiseAbs().maxCoeff() > rim ? 1.0 : value(random); }, 1,
      blocks);
}

TEST(MarchingCubes, ClosesASphereAroundItsInside) {
  const double radius = 0.53;
  const TriangleMesh mesh = marching_cubes(
      sampled([&](const Vector3d& p) { return (p - Vector3d(0.01, 0.02, -0.01)).norm() - radius; },
              0.05, 2));
  const Topology topology = topology_of(mesh);
  EXPECT_EQ(topology.boundary_edges, 0u);
  EXPECT_EQ(topology.crowded_edges, 0u);
  EXPECT_EQ(topology.twisted_edges, 0u);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_NEAR(testing::volume_of(mesh), 4.0 / 3 * pi * std::pow(radius, 3), 0.005);
  // Euler: V - E + F = 2, with 3 F = 2 E.
  EXPECT_EQ(mesh.vertices.size(), mesh.triangles.size() / 2 + 2);
}

TEST(MarchingCubes, HasNoCracksAndNoCrowdedEdgesInRandomFields) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const TriangleMesh mesh = marching_cubes(random_field(seed, 1));
    const Topology topology = topology_of(mesh);
    EXPECT_GT(mesh.triangles.size(), 5000u);
    EXPECT_EQ(topology.boundary_edges, 0u);
    EXPECT_EQ(topology.crowded_edges, 0u);
    EXPECT_EQ(topology.twisted_edges, 0u);
    EXPECT_GT(testing::volume_of(mesh), 0);
  }
}

TEST(MarchingCubes, MakesNoTrianglesWithoutArea) {
  // All corners of a plane through the lattice are exactly zero.
  for (const double height : {0.0, 1e-9, -1e-9}) {
    const TriangleMesh mesh =
        marching_cubes(sampled([&](const Vector3d& p) { return p.z() - height; }, 0.05, 1));
    ASSERT_FALSE(mesh.triangles.empty());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      EXPECT_GT(testing::area_of(mesh, t), 1e-5);
  }
}

TEST(MarchingCubes, UsesEveryVertex) {
  const TriangleMesh mesh = marching_cubes(random_field(3, 1));
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) used.at(v) = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

TEST(MarchingCubes, EndsWhereTheFieldIsUnknown) {
  const TriangleMesh mesh = marching_cubes(sampled(
      [](const Vector3d& p) { return p.x() > 0.101 ? std::nan("") : p.z() - 0.01; }, 0.05, 1));
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Eigen::Vector3f& v : mesh.vertices) EXPECT_LE(v.x(), 0.1001f);
}

TEST(MarchingCubes, EndsWhereThereAreNoCrossings) {
  DistanceField field = sampled([](const Vector3d& p) { return p.z() - 0.01; }, 0.05, 1);
  std::fill(field.crossings.begin(), field.crossings.end(), std::uint8_t{0});
  EXPECT_TRUE(marching_cubes(field).triangles.empty());
}

TEST(MarchingCubes, FacesFreeSpace) {
  const TriangleMesh mesh =
      marching_cubes(sampled([](const Vector3d& p) { return 0.02 - p.z(); }, 0.05, 1));
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f n = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                  .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_LT(n.z(), 0);
  }
}

/// All sign patterns, with every way that ambiguous faces can be decided: random values reach them.
TEST(CellLoops, CrossEachEdgeOnceAndTriangulateWithoutEdgesInFaces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(0.01f, 1);
  for (int trial = 0; trial < 256 * 200; ++trial) {
    std::array<float, 8> distance;
    for (std::size_t k = 0; k < 8; ++k)
      distance[k] = (trial % 256 >> k & 1) != 0 ? -value(random) : value(random);
    std::multiset<int> crossed, on_loops;
    for (int edge = 0; edge < 12; ++edge) {
      const auto [a, b] = corners_of_edge(edge);
      if ((distance[std::size_t(a)] < 0) != (distance[std::size_t(b)] < 0)) crossed.insert(edge);
    }
    const CellLoops loops = cell_loops(distance);
    for (std::size_t l = 0; l < std::size_t(loops.count); ++l) {
      const int n = loops.length[l];
      ASSERT_GE(n, 3);
      for (std::size_t k = 0; k < std::size_t(n); ++k) on_loops.insert(loops.edges[l][k]);
      const LoopTriangles filling = triangulate_loop(loops.edges[l].data(), n);
      const bool has_centre = filling.count == n;
      ASSERT_TRUE(has_centre || filling.count == n - 2);
      for (std::size_t t = 0; t < std::size_t(filling.count); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
          const int i = filling.corners[t][k], j = filling.corners[t][(k + 1) % 3];
          if (i == centre_of_loop || j == centre_of_loop) {
            EXPECT_TRUE(has_centre);
            continue;
          }
          if ((i + 1) % n == j || (j + 1) % n == i) continue;
          ASSERT_FALSE(in_one_face(loops.edges[l][std::size_t(i)], loops.edges[l][std::size_t(j)]))
              << "pattern " << trial % 256;
        }
    }
    EXPECT_EQ(crossed, on_loops);
  }
}

}  // namespace
}  // namespace planum
