#include "slam/registration/icp.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "slam/io/uos.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tests/slam/registration/simulated_room.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::random_motion;
using testing::scan_of;
using testing::shift_between;

/// Two scans of the room and how they truly lie.
struct RoomPair {
  MatchingScan target, source;
  Pose target_from_source;
};

RoomPair room_pair(std::uint64_t number = 1) {
  const Building room = testing::furnished_room();
  const Pose at_a = pose_from_xyz_ypr({1.2, 1.4, 1.0}, 0.5, 0, 0);
  const Pose at_b = pose_from_xyz_ypr({1.9, 1.9, 1.02}, 0.9, 0.02, -0.01);
  return {matching_scan(scan_of(room, at_a, 2 * number)),
          matching_scan(scan_of(room, at_b, 2 * number + 1)), at_a.inverse() * at_b};
}

TEST(Icp, RecoversAKnownMotionFromRandomStarts) {
  const RoomPair pair = room_pair();
  std::mt19937 random(1);
  for (int start = 0; start < 10; ++start) {
    const Pose guess = pair.target_from_source * random_motion(random, 0.4, radians(10));
    const Alignment alignment = align(pair.source, pair.target, guess);
    EXPECT_TRUE(alignment.converged);
    EXPECT_LT(shift_between(alignment.target_from_source, pair.target_from_source), 0.003);
    EXPECT_LT(rotation_angle(alignment.target_from_source, pair.target_from_source), radians(0.1));
    EXPECT_GT(alignment.overlap, 0.5);
    EXPECT_LT(alignment.rms, 0.01);
    EXPECT_EQ(alignment.weak_directions, 0);
  }
}

TEST(Icp, RecoversAKnownMotionByEveryPairingOfPlanes) {
  const RoomPair pair = room_pair();
  for (const Pairing pairing :
       {Pairing::point_to_plane, Pairing::plane_to_plane, Pairing::symmetric}) {
    std::mt19937 random(8);
    for (int start = 0; start < 4; ++start) {
      const Pose guess = pair.target_from_source * random_motion(random, 0.4, radians(10));
      const Alignment alignment = align(pair.source, pair.target, guess, {.pairing = pairing});
      EXPECT_TRUE(alignment.converged) << int(pairing);
      EXPECT_LT(shift_between(alignment.target_from_source, pair.target_from_source), 0.004)
          << int(pairing);
      EXPECT_LT(rotation_angle(alignment.target_from_source, pair.target_from_source),
                radians(0.1));
    }
  }
}

TEST(Icp, RecoversAKnownMotionByEveryMinimizer) {
  const RoomPair pair = room_pair();
  std::mt19937 random(9);
  const Pose guess = pair.target_from_source * random_motion(random, 0.2, radians(4));
  IcpParams params{
      .pairing = Pairing::point_to_point, .last_gate = 0.1, .max_iterations = 100, .max_points = 0};
  const Alignment expected = align(pair.source, pair.target, guess, params);
  for (const Minimizer minimizer :
       {Minimizer::quaternion, Minimizer::dual_quaternion, Minimizer::orthonormal, Minimizer::helix,
        Minimizer::small_angle, Minimizer::lu_milios}) {
    params.minimizer = minimizer;
    const Alignment alignment = align(pair.source, pair.target, guess, params);
    EXPECT_LT(shift_between(alignment.target_from_source, expected.target_from_source), 0.002)
        << int(minimizer);
  }
}

TEST(Icp, FindsItsWayFromFar) {
  const RoomPair pair = room_pair();
  std::mt19937 random(10);
  for (int start = 0; start < 10; ++start) {
    const Pose guess = pair.target_from_source * random_motion(random, 1.0, radians(15));
    const Alignment alignment = align(pair.source, pair.target, guess, {.first_gate = 2.5});
    EXPECT_LT(shift_between(alignment.target_from_source, pair.target_from_source), 0.003);
  }
}

TEST(Icp, RecoversAKnownMotionPointToPoint) {
  const RoomPair pair = room_pair();
  std::mt19937 random(2);
  for (int start = 0; start < 3; ++start) {
    const Pose guess = pair.target_from_source * random_motion(random, 0.2, radians(4));
    const Alignment alignment =
        align(pair.source, pair.target, guess,
              {.pairing = Pairing::point_to_point, .last_gate = 0.1, .max_iterations = 100});
    EXPECT_LT(shift_between(alignment.target_from_source, pair.target_from_source), 0.03);
    EXPECT_LT(rotation_angle(alignment.target_from_source, pair.target_from_source), radians(0.7));
  }
}

TEST(Icp, LeavesAScanOnItself) {
  const RoomPair pair = room_pair();
  for (const Pairing pairing : {Pairing::point_to_point, Pairing::point_to_plane}) {
    const Alignment alignment =
        align(pair.target, pair.target, Pose::Identity(), {.pairing = pairing});
    EXPECT_TRUE(alignment.converged);
    EXPECT_TRUE(alignment.information.allFinite());
    EXPECT_LT(alignment.target_from_source.translation().norm(), 1e-6);
    EXPECT_GT(alignment.overlap, 0.85);
  }
}

TEST(Icp, DoesNotMindAThinWallBetween) {
  // Two rooms side by side, 10 cm apart, scanned from either side: only the wall is near.
  BuildingPlan plan;
  plan.rooms = {{.name = "left", .walls = {.outer = {{0, 0}, {4, 0}, {4, 3}, {0, 3}}}},
                {.name = "right", .walls = {.outer = {{4.1, 0}, {8.1, 0}, {8.1, 3}, {4.1, 3}}}}};
  const Building building = built(plan);
  const Pose left = pose_from_xyz_ypr({2, 1.5, 1}, 0, 0, 0);
  const Pose right = pose_from_xyz_ypr({6, 1.5, 1}, pi, 0, 0);
  const Alignment alignment =
      align(matching_scan(scan_of(building, right, 1)), matching_scan(scan_of(building, left, 2)),
            left.inverse() * right);
  EXPECT_LT(alignment.overlap, 0.05);
}

TEST(Icp, KeepsTheGuessAlongABareCorridor) {
  const Building corridor = testing::bare_corridor();
  const Pose at_a = pose_from_xyz_ypr({0, 0.1, 1}, 0.1, 0, 0);
  const Pose at_b = pose_from_xyz_ypr({1, -0.1, 1}, -0.1, 0, 0);
  const MatchingScan target = matching_scan(scan_of(corridor, at_a, 1));
  const MatchingScan source = matching_scan(scan_of(corridor, at_b, 2));
  // Off along the corridor, which cannot be seen, and across it, which can.
  const Pose off(Eigen::Translation3d(0.2, 0.05, 0.03));
  const Alignment alignment = align(source, target, at_a.inverse() * off * at_b);
  const Eigen::Vector3d found = (at_a * alignment.target_from_source).translation();
  EXPECT_EQ(alignment.weak_directions, 1);
  EXPECT_NEAR(found.x(), 1.2, 0.01) << "as the guess has it";
  EXPECT_NEAR(found.y(), -0.1, 0.005);
  EXPECT_NEAR(found.z(), 1, 0.005);
  const Vector6d along = [&] {
    Vector6d v = Vector6d::Zero();
    v.head<3>() = at_b.linear().transpose() * Eigen::Vector3d::UnitX();
    return v;
  }();
  const Vector6d across = [&] {
    Vector6d v = Vector6d::Zero();
    v.head<3>() = at_b.linear().transpose() * Eigen::Vector3d::UnitY();
    return v;
  }();
  EXPECT_LT(along.dot(alignment.information * along),
            1e-3 * across.dot(alignment.information * across));
}

TEST(Icp, HasHonestInformation) {
  double sum = 0;
  constexpr int draws = 8;
  for (int draw = 0; draw < draws; ++draw) {
    const RoomPair pair = room_pair(static_cast<std::uint64_t>(10 + draw));
    const Alignment alignment = align(pair.source, pair.target, pair.target_from_source);
    const Vector6d error =
        log_se3(alignment.target_from_source.inverse() * pair.target_from_source);
    sum += error.dot(alignment.information * error);
  }
  // The expectation is 6. What the local planes do to edges is no noise, hence the upper limit.
  EXPECT_GT(sum / draws, 1.5);
  EXPECT_LT(sum / draws, 24);
}

TEST(Icp, SaysSoWhenNothingOverlaps) {
  const RoomPair pair = room_pair();
  const Pose guess(Eigen::Translation3d(100, 0, 0));
  const Alignment alignment = align(pair.source, pair.target, guess);
  EXPECT_FALSE(alignment.converged);
  EXPECT_EQ(alignment.pairs, 0u);
  EXPECT_EQ(alignment.overlap, 0);
  EXPECT_TRUE(alignment.target_from_source.isApprox(guess));
  EXPECT_TRUE(alignment.information.isZero());
}

TEST(Icp, SaysSoWhenAScanIsEmpty) {
  const MatchingScan room = room_pair().target, empty = matching_scan({});
  for (const Alignment& alignment :
       {align(empty, room, Pose::Identity()), align(room, empty, Pose::Identity()),
        align(empty, empty, Pose::Identity())}) {
    EXPECT_FALSE(alignment.converged);
    EXPECT_EQ(alignment.pairs, 0u);
    EXPECT_TRUE(alignment.target_from_source.isApprox(Pose::Identity()));
    EXPECT_TRUE(alignment.information.isZero());
  }
}

TEST(Icp, MatchesAScanOfASinglePlaneAsFarAsItGoes) {
  Cloud wall;
  for (int i = 0; i < 80; ++i)
    for (int j = 0; j < 60; ++j)
      wall.points.emplace_back(2, -2 + 0.05f * static_cast<float>(i),
                               -1.5f + 0.05f * static_cast<float>(j));
  const MatchingScan scan = matching_scan(wall);
  const Pose guess(Eigen::Translation3d(0.1, 0.2, 0.3));
  const Alignment alignment = align(scan, scan, guess);
  EXPECT_EQ(alignment.weak_directions, 3);
  EXPECT_TRUE(alignment.target_from_source.matrix().allFinite());
  EXPECT_TRUE(alignment.information.allFinite());
  EXPECT_NEAR(alignment.target_from_source.translation().x(), 0, 1e-4);
  EXPECT_NEAR(alignment.target_from_source.translation().y(), 0.2, 1e-4);
  EXPECT_NEAR(alignment.target_from_source.translation().z(), 0.3, 1e-4);
}

TEST(Icp, IsTheSameForAnyNumberOfThreads) {
  const RoomPair pair = room_pair();
  const Pose guess = pair.target_from_source * Pose(Eigen::Translation3d(0.1, 0.1, 0));
  const auto with = [&](int threads) {
    const testing::ThreadCount count(threads);
    return align(pair.source, pair.target, guess);
  };
  const Alignment one = with(1), many = with(4);
  EXPECT_EQ(one.target_from_source.matrix(), many.target_from_source.matrix());
  EXPECT_EQ(one.information, many.information);
  EXPECT_EQ(one.iterations, many.iterations);
}

TEST(Icp, RefusesBadParameters) {
  const MatchingScan scan = matching_scan({});
  const auto message = [&](const IcpParams& params) {
    return message_of([&] { align(scan, scan, Pose::Identity(), params); });
  };
  EXPECT_NE(message({.first_gate = 0}).find("first_gate must be > 0 m, got 0"), std::string::npos);
  EXPECT_NE(message({.first_gate = 0.1, .last_gate = 0.2})
                .find("last_gate must be between 0 and first_gate, got 0.2"),
            std::string::npos);
  EXPECT_NE(message({.gate_factor = 1}).find("gate_factor"), std::string::npos);
  EXPECT_NE(message({.max_normal_angle = 4}).find("between 0 and 180 deg, got 229"),
            std::string::npos);
  EXPECT_NE(message({.min_pairs = 5}).find("min_pairs must be >= 6, got 5"), std::string::npos);
  Pose guess = Pose::Identity();
  guess.translation().x() = std::nan("");
  EXPECT_EQ(message_of([&] { align(scan, scan, guess); }), "registration: the guess is not finite");
}

TEST(Icp, FindsTheReferenceOfARealCorridor) {
  PLANUM_SHARED_DATASET(folder, "kurt3d_corridor");
  std::vector<MatchingScan> scans;
  for (const char* name : {"scan000.3d", "scan001.3d", "scan002.3d"})
    scans.push_back(matching_scan(limited(read_uos_scan(folder / name)).cloud));
  // The independent solution in the data's README.
  const std::vector<Pose> reference = {
      Pose::Identity(), pose_from_uos({-3.809, -5.898, 156.411}, {1.308, -0.828, -0.516}),
      pose_from_uos({-8.262, -13.725, 339.371}, {0.367, -0.488, -0.309})};
  const std::vector<Pose> given = {Pose::Identity(), read_uos_pose(folder / "scan001.pose"),
                                   read_uos_pose(folder / "scan002.pose")};
  std::mt19937 random(1);
  for (std::size_t i = 0; i < 2; ++i) {
    const Pose truth = reference[i].inverse() * reference[i + 1];
    for (int start = 0; start < 4; ++start) {
      const Pose guess =
          given[i].inverse() * given[i + 1] * random_motion(random, 0.25, radians(5));
      const Alignment alignment = align(scans[i + 1], scans[i], guess);
      const double shift = shift_between(alignment.target_from_source, truth);
      const double turn = rotation_angle(alignment.target_from_source, truth);
      EXPECT_TRUE(alignment.converged);
      EXPECT_LT(shift, 0.03);
      EXPECT_LT(turn, radians(0.7));
      RecordProperty("shift_mm_" + std::to_string(i), static_cast<int>(1000 * shift));
    }
  }
}

}  // namespace
}  // namespace planum
