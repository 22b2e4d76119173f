#include "meshing/half_edge.hpp"

#include <random>
#include <set>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/meshing/synthetic_mesh.hpp"

namespace planum {
namespace {

TriangleMesh fan_of_two_sheets() {
  // Two triangles that share only vertex 0.
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
}

void expect_consistent(const HalfEdges& edges) {
  for (std::uint32_t h = 0; h < edges.opposite.size(); ++h) {
    const std::uint32_t back = edges.opposite[h];
    if (back == HalfEdges::none) continue;
    ASSERT_EQ(edges.opposite[back], h);
    ASSERT_EQ(edges.from(back), edges.to(h));
    ASSERT_EQ(edges.to(back), edges.from(h));
  }
}

TEST(HalfEdges, PairEveryEdgeOfAClosedSurface) {
  const TriangleMesh ball = testing::MarchingTetrahedra::surface(
      [](const Eigen::Vector3d& p) { return p.norm() - 1; }, Eigen::Vector3d::Constant(-1.3),
      Eigen::Vector3d::Constant(1.3), 0.2);
  ASSERT_GT(ball.triangles.size(), 500u);
  const HalfEdges edges = half_edges(ball);
  expect_consistent(edges);
  EXPECT_EQ(std::count(edges.opposite.begin(), edges.opposite.end(), HalfEdges::none), 0);
  EXPECT_EQ(edges.complex_edges, 0u);
  EXPECT_EQ(edges.split_vertices, 0u);
}

/// For each half-edge 3 f + k the face on its other side, as OpenMesh has it; -1 at the rim.
std::vector<int> opposite_faces_of_openmesh(const TriangleMesh& mesh) {
  OpenMesh::TriMesh_ArrayKernelT<> reference;
  std::vector<OpenMesh::VertexHandle> handles;
  for (const Eigen::Vector3f& v : mesh.vertices)
    handles.push_back(reference.add_vertex({v.x(), v.y(), v.z()}));
  std::vector<int> result;
  for (const auto& [a, b, c] : mesh.triangles)
    EXPECT_TRUE(reference.add_face(handles[a], handles[b], handles[c]).is_valid());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto half_edge =
          reference.find_halfedge(handles[triangle[k]], handles[triangle[(k + 1) % 3]]);
      result.push_back(reference.opposite_face_handle(half_edge).idx());
    }
  return result;
}

TEST(HalfEdges, KnowTheNeighboursThatOpenMeshKnows) {
  const auto wave = [](const Eigen::Vector3d& p) {
    return p.z() - 0.3 * std::sin(2 * p.x()) * std::cos(3 * p.y());  // a sheet with a rim
  };
  const auto ring = [](const Eigen::Vector3d& p) {
    return 0.3 - std::hypot(std::hypot(p.x(), p.y()) - 0.8, p.z());
  };
  for (const testing::Field& field : {testing::Field(wave), testing::Field(ring)}) {
    const TriangleMesh mesh = testing::MarchingTetrahedra::surface(
        field, Eigen::Vector3d::Constant(-1.3), Eigen::Vector3d::Constant(1.3), 0.15);
    ASSERT_GT(mesh.triangles.size(), 500u);
    const HalfEdges edges = half_edges(mesh);
    const std::vector<int> expected = opposite_faces_of_openmesh(mesh);
    for (std::uint32_t h = 0; h < edges.opposite.size(); ++h) {
      const std::uint32_t back = edges.opposite[h];
      ASSERT_EQ(back == HalfEdges::none ? -1 : static_cast<int>(back / 3), expected[h]) << h;
    }
  }
}

TEST(HalfEdges, GiveEachFanItsOwnVertex) {
  const HalfEdges edges = half_edges(fan_of_two_sheets());
  EXPECT_EQ(edges.split_vertices, 1u);
  EXPECT_EQ(edges.source.size(), 6u);
  EXPECT_NE(edges.triangles[0][0], edges.triangles[1][0]);
  EXPECT_EQ(edges.source[edges.triangles[1][0]], 0u);
}

TEST(HalfEdges, PairThreeTrianglesAtAnEdgeByTheirNormals) {
  // A floor of two triangles and a wall on their common edge.
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1, 0}, {0.5f, -1, 0}, {0.5f, 0, 1}},
                          {{0, 1, 4}, {0, 1, 2}, {1, 0, 3}}};
  const HalfEdges edges = half_edges(mesh);
  EXPECT_EQ(edges.complex_edges, 1u);
  EXPECT_EQ(edges.opposite[3], 6u);  // the two halves of the floor
  EXPECT_EQ(edges.opposite[0], HalfEdges::none);
  expect_consistent(edges);
}

TEST(HalfEdges, KeepTheNeighboursOfADegenerateTriangleTogether) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                          {{0, 1, 2}, {1, 2, 2}, {2, 1, 3}}};
  const HalfEdges edges = half_edges(mesh);
  EXPECT_EQ(edges.degenerate, 1u);
  EXPECT_EQ(edges.opposite[1], 6u);
}

TEST(HalfEdges, StayConsistentOnRandomMeshes) {
  std::mt19937 random(7);
  for (int draw = 0; draw < 200; ++draw) {
    TriangleMesh mesh;
    const std::uint32_t vertices = 3 + random() % 12;
    for (std::uint32_t i = 0; i < vertices; ++i) mesh.vertices.push_back(Eigen::Vector3f::Random());
    for (std::uint32_t i = 0; i < 60; ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(random() % vertices),
                                static_cast<std::uint32_t>(random() % vertices),
                                static_cast<std::uint32_t>(random() % vertices)});
    const HalfEdges edges = half_edges(mesh);
    expect_consistent(edges);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_EQ(edges.source[edges.triangles[f][k]], mesh.triangles[f][k]);
    // Around each vertex there is one fan: turning from any corner meets every other.
    std::vector<std::set<std::uint32_t>> corners(edges.source.size());
    for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
      if (!edges.is_degenerate(h / 3)) corners[edges.from(h)].insert(h);
    for (const auto& all : corners) {
      if (all.empty()) continue;
      std::set<std::uint32_t> met{*all.begin()};
      for (std::uint32_t h = *all.begin();;) {
        h = edges.opposite[HalfEdges::previous(h)];
        if (h == HalfEdges::none || !met.insert(h).second) break;
      }
      for (std::uint32_t h = *all.begin();;) {
        h = edges.opposite[h];
        if (h == HalfEdges::none || !met.insert(h = HalfEdges::next(h)).second) break;
      }
      ASSERT_EQ(met, all);
    }
  }
}

TEST(HalfEdges, RefuseWhatIsNoMesh) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}};
  try {
    half_edges(mesh);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "mesh: triangle 0 names vertex 2 of 2");
  }
  mesh = {{{0, 0, 0}, {1, 0, NAN}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(half_edges(mesh), Error);
}

}  // namespace
}  // namespace planum
