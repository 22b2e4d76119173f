#include "slam/graph/held_out_loops.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/g2o_pose_graph.hpp"
#include "slam/graph/graph_optimization.hpp"
#include "tests/slam/graph/synthetic_graph.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::synthetic_graph;
using testing::SyntheticGraph;

std::size_t count(const HeldOutLoops& held_out) {
  std::size_t known = 0;
  for (const auto& residual : held_out.residuals)
    if (residual) ++known;
  return known;
}

TEST(EdgeResidual, IsThatWhichWasPutIn) {
  const std::vector<Pose> poses = {Pose::Identity(), pose_from_xyz_ypr({3, 4, 0}, 0.2, 0, 0)};
  Edge edge{.from = 0, .to = 1, .from_from_to = poses[1]};
  edge.information = Matrix6d::Identity() / (0.03 * 0.03);
  const EdgeNoise none{.translation = 0, .rotation = 0};
  EXPECT_NEAR(edge_residual(edge, poses).translation, 0, 1e-12);
  Vector6d error;
  error << 0.3, 0, 0.4, 0, 0, 0;
  edge.from_from_to = poses[1] * exp_se3(-error);
  EXPECT_NEAR(edge_residual(edge, poses, none).translation, 0.5, 1e-9);
  EXPECT_NEAR(edge_residual(edge, poses, none).rotation, 0, 1e-9);
  EXPECT_NEAR(edge_residual(edge, poses, none).deviations, 0.5 / 0.03, 1e-6);
  // Variances of the match and of what it may be off beyond that add up.
  EXPECT_NEAR(edge_residual(edge, poses, {.translation = 0.04, .rotation = 0}).deviations,
              0.5 / 0.05, 1e-6);
  error << 0, 0, 0, 0, radians(2), 0;
  edge.from_from_to = poses[1] * exp_se3(-error);
  EXPECT_NEAR(degrees(edge_residual(edge, poses, none).rotation), 2, 1e-6);
}

TEST(EdgeResidual, CountsNothingWhereTheEdgeKnowsNothing) {
  const std::vector<Pose> poses(2, Pose::Identity());
  Edge edge{.from = 0, .to = 1};
  edge.information.setZero();
  edge.information(2, 2) = 1e4;
  edge.from_from_to.translation() = Eigen::Vector3d(5, 3, 0);
  EXPECT_NEAR(edge_residual(edge, poses).deviations, 0, 1e-9);
  EXPECT_NEAR(edge_residual(edge, poses).translation, std::sqrt(34.0), 1e-9);
}

TEST(HeldOutLoops, WithAFoldEachAreThoseOfGraphsWithoutThem) {
  const PoseGraph graph = synthetic_graph<SpatialManifold>(60, 6, 0, 1).graph;
  const HeldOutLoops held_out = held_out_loops(graph, {.folds = 100});
  EXPECT_EQ(held_out.solved, 6u);
  EXPECT_EQ(held_out.converged, 6u);
  for (std::size_t k = 0; k < graph.edges.size(); ++k) {
    ASSERT_EQ(held_out.residuals[k].has_value(), graph.edges[k].kind == EdgeKind::loop);
    if (!held_out.residuals[k]) continue;
    PoseGraph rest = graph;
    rest.edges.erase(rest.edges.begin() + static_cast<std::ptrdiff_t>(k));
    const OptimizedGraph solved = optimize(rest, {.rejection = LoopRejection::never});
    const EdgeResidual expected = edge_residual(graph.edges[k], solved.poses);
    EXPECT_NEAR(held_out.residuals[k]->translation, expected.translation, 1e-5);
    EXPECT_NEAR(held_out.residuals[k]->rotation, expected.rotation, 1e-6);
  }
}

TEST(HeldOutLoops, SolvesAsManyGraphsAsThereAreFolds) {
  const PoseGraph graph = synthetic_graph<SpatialManifold>(200, 60, 0, 2).graph;
  const HeldOutLoops held_out = held_out_loops(graph);
  EXPECT_EQ(held_out.solved, 5u);
  EXPECT_EQ(count(held_out), 60u);
}

/// A false loop that was accepted drags the poses to itself; left out, it stands out.
TEST(HeldOutLoops, ShowAFalseLoopThatTheGraphHides) {
  const SyntheticGraph<SpatialManifold> synthetic = synthetic_graph<SpatialManifold>(200, 40, 0, 3);
  PoseGraph graph = synthetic.graph;
  const std::size_t bad = graph.edges.size() - 1;
  graph.edges[bad].from_from_to.translation() += Eigen::Vector3d(0.5, 0, 0);
  const HeldOutLoops held_out = held_out_loops(graph);
  double worst_right = 0;
  for (std::size_t k = 0; k < bad; ++k)
    if (held_out.residuals[k])
      worst_right = std::max(worst_right, held_out.residuals[k]->deviations);
  ASSERT_TRUE(held_out.residuals[bad].has_value());
  EXPECT_GT(held_out.residuals[bad]->deviations, 1.5 * worst_right);
  const double hidden = edge_residual(graph.edges[bad], relax_edges(graph).poses).translation;
  EXPECT_GT(held_out.residuals[bad]->translation, 1.1 * hidden);
}

TEST(HeldOutLoops, LeavesOutRejectedLoopsAndThoseThatAloneJoinParts) {
  PoseGraph graph;
  graph.poses.assign(4, Pose::Identity());
  graph.edges = {{.from = 0, .to = 1},
                 {.from = 2, .to = 3},
                 {.from = 0, .to = 3, .kind = EdgeKind::loop},
                 {.from = 1, .to = 3, .kind = EdgeKind::loop, .accepted = false}};
  const HeldOutLoops held_out = held_out_loops(graph);
  EXPECT_EQ(count(held_out), 0u);
  graph.edges[3].accepted = true;
  EXPECT_EQ(count(held_out_loops(graph)), 2u);
}

TEST(HeldOutLoops, MovingTheWorldChangesNothing) {
  PoseGraph graph = synthetic_graph<SpatialManifold>(80, 10, 0, 4).graph;
  const HeldOutLoops here = held_out_loops(graph);
  for (Pose& pose : graph.poses) pose = pose_from_xyz_ypr({9, -8, 7}, 1, 0.5, -0.5) * pose;
  const HeldOutLoops there = held_out_loops(graph);
  for (std::size_t k = 0; k < graph.edges.size(); ++k)
    if (here.residuals[k]) {
      EXPECT_NEAR(here.residuals[k]->translation, there.residuals[k]->translation, 1e-5);
    }
}

TEST(HeldOutLoops, OfAGarageAreForetoldByTheOthers) {
  PLANUM_SHARED_DATASET(graphs, "pose_graphs");
  const G2oGraph file = read_g2o(graphs / "parking-garage.g2o");
  const PoseGraph graph = spatial_graph(file, g2o_index(file));
  const HeldOutLoops held_out = held_out_loops(graph);
  EXPECT_EQ(held_out.converged, 5u);
  EXPECT_EQ(count(held_out), 4615u);
  std::vector<double> translations;
  for (const auto& residual : held_out.residuals)
    if (residual) translations.push_back(residual->translation);
  std::sort(translations.begin(), translations.end());
  EXPECT_LT(translations[translations.size() / 2], 0.2);
}

TEST(HeldOutLoops, SaysWhatIsWrong) {
  PoseGraph graph = synthetic_graph<SpatialManifold>(20, 3, 0, 5).graph;
  EXPECT_THROW(held_out_loops(graph, {.folds = 1}), Error);
  graph.edges[0].to = 99;
  EXPECT_THROW(held_out_loops(graph), Error);
  EXPECT_TRUE(held_out_loops({}).residuals.empty());
}

}  // namespace
}  // namespace planum
