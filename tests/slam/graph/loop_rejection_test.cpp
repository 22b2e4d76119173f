#include <gtest/gtest.h>

#include "slam/graph/graph_optimization.hpp"
#include "tests/slam/graph/synthetic_graph.hpp"

namespace planum {
namespace {

using testing::position_rms;
using testing::synthetic_graph;
using testing::SyntheticGraph;

/// How a choice of loops compares with the truth.
struct Verdict {
  int false_kept = 0, right_dropped = 0, right = 0;
  bool odometry_kept = true;
};

template <class Manifold>
Verdict verdict(const SyntheticGraph<Manifold>& made, const GraphQuality& quality) {
  Verdict result;
  for (std::size_t i = 0; i < made.graph.edges.size(); ++i) {
    if (made.graph.edges[i].kind == EdgeKind::odometry) {
      result.odometry_kept &= quality.counts[i];
    } else if (made.false_loop[i]) {
      result.false_kept += quality.counts[i] ? 1 : 0;
    } else {
      ++result.right;
      result.right_dropped += quality.counts[i] ? 0 : 1;
    }
  }
  return result;
}

template <class Manifold>
class LoopRejections : public ::testing::Test {};
using Manifolds = ::testing::Types<SpatialManifold, PlanarManifold>;
TYPED_TEST_SUITE(LoopRejections, Manifolds);

TYPED_TEST(LoopRejections, DropFalseLoopsAndKeepTheOthers) {
  using M = TypeParam;
  for (const double share : {0.1, 0.3}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const SyntheticGraph<M> made = synthetic_graph<M>(200, 60, share, seed);
      const auto result = optimize(made.graph);
      const Verdict found = verdict(made, result.quality);
      EXPECT_EQ(found.false_kept, 0) << share << " false, seed " << seed;
      EXPECT_LE(found.right_dropped, 1 + found.right / 20) << share << " false, seed " << seed;
      EXPECT_TRUE(found.odometry_kept);
      EXPECT_TRUE(result.quality.converged);
      EXPECT_LT(position_rms<M>(result.poses, made.truth), 0.5) << share << ", seed " << seed;
    }
  }
}

TYPED_TEST(LoopRejections, AreNoneWhereAllLoopsAreRight) {
  using M = TypeParam;
  for (unsigned seed = 20; seed < 25; ++seed) {
    const SyntheticGraph<M> made = synthetic_graph<M>(200, 100, 0, seed);
    const Verdict found = verdict(made, optimize(made.graph).quality);
    EXPECT_EQ(found.right_dropped, 0) << "seed " << seed;
  }
}

TYPED_TEST(LoopRejections, AreNoneIfForbidden) {
  using M = TypeParam;
  const SyntheticGraph<M> made = synthetic_graph<M>(100, 30, 0.3, 5);
  const auto result = optimize(made.graph, {.rejection = LoopRejection::never});
  for (const bool counts : result.quality.counts) EXPECT_TRUE(counts);
  EXPECT_GT(result.quality.cost_after, 1e4);
}

TYPED_TEST(LoopRejections, FindFalseLoopsThatInformationTooModestWouldAllow) {
  using M = TypeParam;
  SyntheticGraph<M> made = synthetic_graph<M>(200, 60, 0.3, 6);
  for (auto& edge : made.graph.edges) edge.information *= 1e-4;  // claims 2 m and 30 degrees
  const auto result = optimize(made.graph, {.rejection = LoopRejection::always});
  const Verdict found = verdict(made, result.quality);
  EXPECT_EQ(found.false_kept, 0);
  EXPECT_LE(found.right_dropped, found.right / 10);
  EXPECT_LT(result.quality.noise_scale, 0.05);
  EXPECT_LT(position_rms<M>(result.poses, made.truth), 0.5);
}

}  // namespace
}  // namespace planum
