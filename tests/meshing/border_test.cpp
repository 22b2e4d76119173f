#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "meshing/borders.hpp"
#include "meshing/gap_closing.hpp"
#include "meshing/ring_crossings.hpp"
#include "meshing/rings.hpp"
#include "tests/meshing/scenes.hpp"

namespace planum {
namespace {

/// n x n squares of two triangles in the plane z = 0.
TriangleMesh grid(std::uint32_t n) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      mesh.vertices.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.f);
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 2, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

TEST(Borders, OfFourQuartersMeetInTheMiddle) {
  const TriangleMesh mesh = grid(4);
  const HalfEdges edges = half_edges(mesh);
  std::vector<std::uint32_t> labels;
  for (std::uint32_t square = 0; square < 16; ++square)
    labels.insert(labels.end(), 2, (square % 4 / 2) + 2 * (square / 8));
  const auto chains = border_chains(edges, labels);
  // Four lines from the middle to the sides, four corners outside.
  EXPECT_EQ(chains.size(), 8u);
  for (const BorderChain& chain : chains) {
    EXPECT_FALSE(chain.closed);
    EXPECT_EQ(chain.half_edges.size(), chain.right == outside_mesh ? 4u : 2u);
  }
  const auto rings = border_rings(edges, labels, chains);
  ASSERT_EQ(rings.size(), 4u);
  for (const BorderRing& ring : rings) EXPECT_EQ(ring.chains.size(), 3u);
}

TEST(Borders, OfAnIslandAreClosed) {
  const TriangleMesh mesh = grid(5);
  const HalfEdges edges = half_edges(mesh);
  std::vector<std::uint32_t> labels(50, 0);
  labels[2 * 12] = labels[2 * 12 + 1] = 1;  // the square in the middle
  const auto chains = border_chains(edges, labels);
  ASSERT_EQ(chains.size(), 2u);
  EXPECT_TRUE(chains[0].closed && chains[1].closed);
  EXPECT_EQ(border_rings(edges, labels, chains).size(), 3u);  // with the hole of region 0
}

TEST(Borders, AreEachInOneChainAndRing) {
  std::mt19937 random(3);
  for (int draw = 0; draw < 100; ++draw) {
    TriangleMesh mesh = grid(8);
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 10 == 0; });
    const HalfEdges edges = half_edges(mesh);
    std::vector<std::uint32_t> labels(mesh.triangles.size());
    for (std::uint32_t& label : labels) label = random() % 4 == 3 ? Regions::rest : random() % 3;
    std::set<std::uint32_t> borders;
    for (std::uint32_t h = 0; h < edges.opposite.size(); ++h)
      if (labels[h / 3] != Regions::rest && label_across(edges, labels, h) != labels[h / 3])
        borders.insert(h);
    std::multiset<std::uint32_t> walked;
    const auto chains = border_chains(edges, labels);
    for (const BorderChain& chain : chains)
      for (std::size_t i = 0; i < chain.half_edges.size(); ++i) {
        const std::uint32_t h = chain.half_edges[i];
        walked.insert(h);
        if (chain.right < outside_mesh) walked.insert(edges.opposite[h]);
        EXPECT_EQ(labels[h / 3], chain.left);
        EXPECT_EQ(label_across(edges, labels, h), chain.right);
        if (i == 0) continue;
        EXPECT_EQ(edges.from(h), edges.to(chain.half_edges[i - 1]));
      }
    EXPECT_EQ(walked, std::multiset<std::uint32_t>(borders.begin(), borders.end()));
    std::map<std::pair<std::uint32_t, bool>, int> uses;
    for (const BorderRing& ring : border_rings(edges, labels, chains))
      for (const ChainUse use : ring.chains) {
        ++uses[{use.chain, use.reversed}];
        const BorderChain& chain = chains[use.chain];
        EXPECT_EQ(use.reversed ? chain.right : chain.left, labels[ring.triangle]);
      }
    std::size_t sides = 0;
    for (const BorderChain& chain : chains) sides += chain.right < outside_mesh ? 2 : 1;
    EXPECT_EQ(uses.size(), sides);
    for (const auto& [use, count] : uses) EXPECT_EQ(count, 1);
  }
}

TEST(SimpleRings, DropSpikesAndCutAtVerticesThatComeTwice) {
  EXPECT_EQ(simple_rings({1, 2, 3}), (std::vector<Ring>{{1, 2, 3}}));
  EXPECT_EQ(simple_rings({1, 1, 2, 3, 3, 1}), (std::vector<Ring>{{1, 2, 3}}));
  EXPECT_EQ(simple_rings({1, 2, 9, 2, 3}), (std::vector<Ring>{{1, 2, 3}}));
  EXPECT_EQ(simple_rings({1, 2, 3, 4, 5, 3, 6}), (std::vector<Ring>{{3, 4, 5}, {1, 2, 3, 6}}));
  EXPECT_TRUE(simple_rings({1, 2, 1, 2}).empty());
  EXPECT_TRUE(simple_rings({}).empty());
}

TEST(RingCrossings, AreThoseOfBruteForce) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(0, 1);
  for (int draw = 0; draw < 100; ++draw) {
    std::vector<Ring> rings(2);
    std::vector<Ring2d> positions(2);
    for (std::uint32_t i = 0; i < 30; ++i) {
      rings[i % 2].push_back(i);
      positions[i % 2].emplace_back(place(random), place(random));
    }
    std::size_t expected = 0;
    for (std::size_t r = 0; r < 2; ++r)
      for (std::size_t i = 0; i < 15; ++i)
        for (std::size_t s = r; s < 2; ++s)
          for (std::size_t j = s == r ? i + 1 : 0; j < 15; ++j) {
            if (r == s && (j == i + 1 || (i == 0 && j == 14))) continue;
            const auto &a = positions[r][i], &b = positions[r][(i + 1) % 15], &c = positions[s][j],
                       &d = positions[s][(j + 1) % 15];
            const auto turn = [](const auto& p, const auto& q, const auto& x) {
              return signed_area(Ring2d{p, q, x}) > 0;
            };
            expected += turn(a, b, c) != turn(a, b, d) && turn(c, d, a) != turn(c, d, b);
          }
    EXPECT_EQ(ring_crossings(rings, positions).size(), expected);
  }
}

TEST(GapClosing, FillsHolesUpToTheirSize) {
  const testing::Vector3d size(2, 2, 2);
  for (const double max_gap : {0.35, 3.0}) {
    TriangleMesh mesh = testing::box_room_mesh(size, 0.1);
    const double whole = testing::area(mesh);
    // A small hole in the floor and one over an edge of the ceiling; a large one in a wall.
    std::erase_if(mesh.triangles, [&](const auto& t) {
      const testing::Vector3d p = mesh.vertices[t[0]].template cast<double>();
      return (p - testing::Vector3d(1, 1, 0)).norm() < 0.14 ||
             (p - testing::Vector3d(0, 1, 2)).norm() < 0.14 ||
             (p - testing::Vector3d(2, 1, 1)).norm() < 0.5;
    });
    HalfEdges edges = half_edges(mesh);
    ASSERT_GT(close_gaps(mesh, edges, max_gap), 0u);
    const HalfEdges fresh = half_edges(mesh);
    EXPECT_EQ(fresh.complex_edges, 0u);
    EXPECT_EQ(fresh.opposite, edges.opposite);
    if (max_gap > 1) {
      EXPECT_EQ(testing::open_edges(mesh), 0u);
      EXPECT_NEAR(testing::area(mesh), whole, 0.01 * whole);
    } else {
      // What is left open is the hole in the wall.
      for (std::uint32_t h = 0; h < edges.opposite.size(); ++h) {
        if (edges.opposite[h] != HalfEdges::none) continue;
        EXPECT_GT(mesh.vertices[edges.source[edges.from(h)]].x(), 1.9f);
      }
    }
  }
}

TEST(GapClosing, LeavesARimThatOnlyBendsOutwards) {
  TriangleMesh mesh = grid(3);
  HalfEdges edges = half_edges(mesh);
  EXPECT_EQ(close_gaps(mesh, edges, 100), 0u);
}

}  // namespace
}  // namespace planum
