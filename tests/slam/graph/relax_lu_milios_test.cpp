#include "slam/graph/relax_lu_milios.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "slam/evaluation/trajectory_error.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/scan_links.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"
#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tests/slam/registration/simulated_room.hpp"
#include "tests/support/numbered.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::numbered;
using testing::random_motion;
using testing::scan_of;
using testing::shift_between;
using testing::Walk;

const Walk& walk() {
  static const Walk result =
      testing::walk_in_room({pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.3, 0, 0),
                             pose_from_xyz_ypr({1.8, 1.6, 1.0}, 0.9, 0.02, 0),
                             pose_from_xyz_ypr({2.2, 3.4, 1.0}, -2.0, 0, 0.02),
                             pose_from_xyz_ypr({4.0, 1.4, 1.0}, 2.5, -0.01, 0)});
  return result;
}

/// Poses a little off, with edges that know of it.
PoseGraph shaken_graph(const std::vector<Pose>& truth, std::mt19937& random, double shift,
                       double turn) {
  PoseGraph graph{.poses = truth, .edges = {}};
  for (std::size_t i = 1; i < truth.size(); ++i) {
    graph.poses[i] = truth[i] * random_motion(random, shift, turn);
    const Pose step = graph.poses[i - 1].inverse() * graph.poses[i];
    graph.edges.push_back({.from = i - 1,
                           .to = i,
                           .from_from_to = step,
                           .information = odometry_information(step),
                           .odometry_information = odometry_information(step)});
  }
  return graph;
}

void expect_truth(const GraphResult& result, const std::vector<Pose>& truth, double shift,
                  double turn_degrees) {
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(shift_between(result.graph.poses[i], truth[i]), shift) << "pose " << i;
    EXPECT_LT(degrees(rotation_angle(result.graph.poses[i], truth[i])), turn_degrees);
  }
}

TEST(RelaxLuMilios, BringsShakenScansTogether) {
  std::mt19937 random(1);
  const Walk& w = walk();
  for (int start = 0; start < 3; ++start) {
    const PoseGraph graph = shaken_graph(w.truth, random, 0.04, radians(0.7));
    const GraphResult result = relax_lu_milios(graph, w.scans);
    EXPECT_TRUE(result.converged);
    EXPECT_GE(result.links.size(), 5u);
    EXPECT_LT(result.residual_after, 0.6 * result.residual_before);
    EXPECT_LT(result.residual_after, 0.005);
    expect_truth(result, w.truth, 0.003, 0.1);
  }
}

// Points that pair with points are drawn to the sampling of the other scan, here 5 cm.
TEST(RelaxLuMilios, WorksPointToPointToo) {
  std::mt19937 random(2);
  const Walk& w = walk();
  const PoseGraph graph = shaken_graph(w.truth, random, 0.08, radians(1.5));
  const GraphResult result = relax_lu_milios(
      graph, w.scans, {.pairing = Pairing::point_to_point, .last_gate = 0.1, .max_iterations = 80});
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.residual_after, result.residual_before);
  expect_truth(result, w.truth, 0.05, 1.2);
}

TEST(RelaxLuMilios, MovesWithTheWorld) {
  std::mt19937 random(3);
  const Walk& w = walk();
  const PoseGraph graph = shaken_graph(w.truth, random, 0.03, radians(0.5));
  PoseGraph moved = graph;
  const Pose motion = random_motion(random, 500, 2);
  for (Pose& pose : moved.poses) pose = motion * pose;
  const GraphResult here = relax_lu_milios(graph, w.scans);
  const GraphResult there = relax_lu_milios(moved, w.scans);
  for (std::size_t i = 0; i < w.truth.size(); ++i)
    EXPECT_LT(shift_between(motion * here.graph.poses[i], there.graph.poses[i]), 1e-5);
}

TEST(RelaxLuMilios, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(4);
  const Walk& w = walk();
  const PoseGraph graph = shaken_graph(w.truth, random, 0.03, radians(0.5));
  const auto with = [&](int threads) {
    const testing::ThreadCount count(threads);
    return relax_lu_milios(graph, w.scans);
  };
  const GraphResult one = with(1), many = with(4);
  EXPECT_EQ(one.iterations, many.iterations);
  EXPECT_EQ(one.residual_after, many.residual_after);
  for (std::size_t i = 0; i < w.truth.size(); ++i)
    EXPECT_EQ(one.graph.poses[i].matrix(), many.graph.poses[i].matrix());
}

TEST(RelaxLuMilios, DoesNotLinkScansOfARejectedLoop) {
  std::mt19937 random(5);
  const Walk& w = walk();
  PoseGraph graph = shaken_graph(w.truth, random, 0.02, radians(0.3));
  graph.edges.push_back({.from = 0, .to = 2, .kind = EdgeKind::loop, .accepted = false});
  for (const Edge& link : relax_lu_milios(graph, w.scans).links)
    EXPECT_FALSE(std::minmax(link.from, link.to) == std::minmax(std::size_t{0}, std::size_t{2}));
}

TEST(RelaxLuMilios, LeavesDuplicatesOfAScanOnEachOther) {
  const Walk& w = walk();
  const std::vector<MatchingScan> scans(3, w.scans[0]);
  std::mt19937 random(6);
  const PoseGraph graph = shaken_graph(std::vector<Pose>(3, w.truth[0]), random, 0.02, 0.01);
  const GraphResult result = relax_lu_milios(graph, scans);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(std::isfinite(result.residual_after));
  for (const Pose& pose : result.graph.poses) {
    EXPECT_TRUE(pose.matrix().allFinite());
    EXPECT_LT(shift_between(pose, w.truth[0]), 1e-3);
  }
}

TEST(RelaxLuMilios, LeavesScansThatShareNothingWhereOdometryHasThem) {
  const Walk& w = walk();
  const std::vector<MatchingScan> scans = {w.scans[0], matching_scan({}), w.scans[1]};
  // No edges at all: every pose is a part of its own.
  PoseGraph graph;
  graph.poses = {Pose::Identity(), Pose(Eigen::Translation3d(5, 0, 0)),
                 Pose(Eigen::Translation3d(200, 0, 0))};
  const GraphResult result = relax_lu_milios(graph, scans);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.links.empty());
  EXPECT_EQ(result.residual_after, 0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_TRUE(result.graph.poses[i].isApprox(graph.poses[i], 1e-12));
}

TEST(RelaxLuMilios, MatchesScansOfASinglePlaneAsFarAsItGoes) {
  Cloud wall;
  for (int i = 0; i < 80; ++i)
    for (int j = 0; j < 60; ++j)
      wall.points.emplace_back(2, -2 + 0.05f * static_cast<float>(i),
                               -1.5f + 0.05f * static_cast<float>(j));
  const std::vector<MatchingScan> scans(2, matching_scan(wall));
  PoseGraph graph;
  graph.poses = {Pose::Identity(), Pose(Eigen::Translation3d(0.0005, 0.1, 0.2))};
  const Pose step = graph.poses[1];
  graph.edges = {{.from = 0,
                  .to = 1,
                  .from_from_to = step,
                  .information = odometry_information(step),
                  .odometry_information = odometry_information(step)}};
  const GraphResult result = relax_lu_milios(graph, scans, {.last_gate = 0.02});
  const Eigen::Vector3d found = result.graph.poses[1].translation();
  EXPECT_NEAR(found.x(), 0, 1e-4);
  EXPECT_NEAR(found.y(), 0.1, 1e-3);
  EXPECT_NEAR(found.z(), 0.2, 1e-3);
}

TEST(RelaxLuMilios, OfNothingIsNothing) {
  const GraphResult result = relax_lu_milios({}, {});
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(result.graph.poses.empty());
}

TEST(RelaxLuMilios, RefusesBadInput) {
  const Walk& w = walk();
  EXPECT_NE(message_of([&] {
              relax_lu_milios({}, w.scans);
            }).find("the number of poses must be that of the scans, got 0"),
            std::string::npos);
  PoseGraph graph{.poses = w.truth, .edges = {}};
  EXPECT_NE(message_of([&] {
              relax_lu_milios(graph, w.scans, {.max_distance = 0});
            }).find("relaxation: max_distance must be > 0 m, got 0"),
            std::string::npos);
  graph.poses[2].translation().z() = std::nan("");
  EXPECT_NE(message_of([&] { relax_lu_milios(graph, w.scans); }).find("pose 2 is not finite"),
            std::string::npos);
}

TEST(ScanLink, KnowsTheDifferenceOfTwoSmallMotions) {
  const Walk& w = walk();
  std::vector<std::vector<std::uint32_t>> selections;
  for (const MatchingScan& scan : w.scans) selections.push_back(scan.selection(5000));
  ScanLink link({0, 1}, w.scans, selections);
  std::mt19937 random(7);
  for (int draw = 0; draw < 5; ++draw) {
    std::vector<Pose> poses = w.truth;
    const Vector6d a = log_se3(random_motion(random, 0.01, 0.003));
    const Vector6d b = log_se3(random_motion(random, 0.01, 0.003));
    poses[0] = exp_se3(a) * poses[0];
    poses[1] = exp_se3(b) * poses[1];
    const LinkFit fit = link.fit(poses, Pairing::point_to_plane, 0.1, radians(45), 50);
    const Vector6d difference =
        fit.equation.information.ldlt().solve(fit.equation.weighted_difference);
    // X_a - X_b brings the scans back.
    EXPECT_LT((difference + (a - b)).head<3>().norm(), 0.004);
    EXPECT_LT((difference + (a - b)).tail<3>().norm(), 0.0015);
    EXPECT_GT(fit.overlap, 0.4);
  }
}

/// All of registration, as the program does it.
GraphResult registered(const std::vector<MatchingScan>& scans, const std::vector<Pose>& odometry,
                       std::vector<Edge>* loops = nullptr) {
  PoseGraph graph = pose_graph(match_in_order(odometry, icp_matcher(scans)));
  const std::vector<Edge> found = find_loops(scans, graph, icp_gated_matcher(scans));
  graph.edges.insert(graph.edges.end(), found.begin(), found.end());
  if (loops) *loops = found;
  return relax_lu_milios(graph, scans);
}

TEST(Registration, MapsABuildingWithARingCorridor) {
  const Building building = demo_building();
  const std::vector<Pose> truth = demo_poses();
  std::vector<MatchingScan> scans;
  for (std::size_t i = 0; i < truth.size(); ++i)
    scans.push_back(matching_scan(scan_of(building, truth[i], i, 0.01)));
  const std::vector<Pose> odometry =
      drifted(truth, {.translation_per_metre = 0.06, .heading_per_metre = 0.02, .seed = 5});
  std::vector<Edge> loops;
  const GraphResult result = registered(scans, odometry, &loops);
  EXPECT_TRUE(result.converged);
  const TrajectoryError before = trajectory_error(numbered(odometry), numbered(truth));
  const TrajectoryError after = trajectory_error(numbered(result.graph.poses), numbered(truth));
  EXPECT_GT(before.ape_translation.rmse, 0.1);
  EXPECT_LT(after.ape_translation.rmse, 0.02);
  EXPECT_LT(after.ape_rotation.mean, 0.2);
  EXPECT_EQ(components({.poses = result.graph.poses, .edges = result.graph.edges}).count, 1u);
  std::size_t accepted = 0;
  for (const Edge& loop : loops) {
    if (!loop.accepted) {
      EXPECT_FALSE(loop.reason.empty());
      continue;
    }
    ++accepted;
    const Pose true_loop = truth[loop.from].inverse() * truth[loop.to];
    EXPECT_LT(shift_between(loop.from_from_to, true_loop), 0.1) << loop.from << "-" << loop.to;
  }
  EXPECT_GT(accepted, 5u);
}

TEST(Registration, MapsTheClassroomFromItsOdometry) {
  PLANUM_SHARED_DATASET(folder, "classroom");
  std::vector<MatchingScan> scans;
  for (int i = 0; i < 12; ++i) {
    const std::string name = "scan0" + std::string(i < 10 ? "0" : "") + std::to_string(i);
    scans.push_back(
        matching_scan(points_from_slices(read_slices(folder / (name + ".slices"))).cloud));
  }
  const Trajectory odometry = read_tum(folder / "odometry.tum");
  std::vector<Pose> poses;
  for (const StampedPose& p : odometry) poses.push_back(p.pose);
  const GraphResult result = registered(scans, poses);
  EXPECT_TRUE(result.converged);
  const TrajectoryError error =
      trajectory_error(numbered(result.graph.poses), read_tum(folder / "truth.tum"));
  RecordProperty("ape_rmse_um", static_cast<int>(1e6 * error.ape_translation.rmse));
  EXPECT_LT(error.ape_translation.rmse, 0.003);
  EXPECT_LT(error.ape_rotation.max, 0.05);
}

TEST(Registration, MapsTheCorridorFromShakenPoses) {
  PLANUM_SHARED_DATASET(folder, "kurt3d_corridor");
  std::vector<MatchingScan> scans;
  std::vector<Pose> given;
  for (const std::string name : {"scan000", "scan001", "scan002"}) {
    scans.push_back(matching_scan(limited(read_uos_scan(folder / (name + ".3d"))).cloud));
    given.push_back(read_uos_pose(folder / (name + ".pose")));
  }
  // The independent solution in the data's README, in the conventions of UOS.
  const std::vector<Pose> reference = {
      Pose::Identity(), pose_from_uos({-3.809, -5.898, 156.411}, {1.308, -0.828, -0.516}),
      pose_from_uos({-8.262, -13.725, 339.371}, {0.367, -0.488, -0.309})};
  std::mt19937 random(1);
  for (int start = 0; start < 3; ++start) {
    std::vector<Pose> odometry = given;
    for (std::size_t i = 1; i < odometry.size(); ++i)
      odometry[i] = odometry[i] * random_motion(random, 0.25, radians(5));
    const std::vector<Pose> poses = registered(scans, odometry).graph.poses;
    for (const auto& [a, b] : std::vector<ScanPair>{{0, 1}, {1, 2}, {0, 2}}) {
      const Pose found = poses[a].inverse() * poses[b];
      const Pose truth = reference[a].inverse() * reference[b];
      EXPECT_LT(shift_between(found, truth), 0.03) << a << "-" << b;
      EXPECT_LT(degrees(rotation_angle(found, truth)), 0.7) << a << "-" << b;
    }
  }
}

}  // namespace
}  // namespace planum
