#include "slam/graph/plane_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "slam/graph/plane_equations.hpp"
#include "slam/graph/plane_patches.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::random_motion;
using testing::scan_of;
using testing::shift_between;
using testing::Walk;

/// Scans of a furnished room; `draw` makes other noise.
Walk walk_in_room(std::uint64_t draw, double noise = 0.005) {
  return testing::walk_in_room({pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.3, 0, 0),
                                pose_from_xyz_ypr({1.8, 1.6, 1.0}, 0.9, 0.02, 0),
                                pose_from_xyz_ypr({2.2, 3.4, 1.0}, -2.0, 0, 0.02),
                                pose_from_xyz_ypr({4.0, 1.4, 1.0}, 2.5, -0.01, 0),
                                pose_from_xyz_ypr({1.2, 2.8, 1.0}, -0.5, 0, 0)},
                               draw, noise);
}

const Walk& walk() {
  static const Walk result = walk_in_room(0);
  return result;
}

/// All but the first pose a little off.
std::vector<Pose> shaken(const std::vector<Pose>& truth, std::mt19937& random, double shift,
                         double turn) {
  std::vector<Pose> poses = truth;
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = truth[i] * random_motion(random, shift, turn);
  return poses;
}

/// m, rms over the poses; 1 rad counts as 3 m.
double error(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  double squares = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    squares += std::pow(shift_between(poses[i], truth[i]), 2) +
               std::pow(3 * rotation_angle(poses[i], truth[i]), 2);
  return std::sqrt(squares / static_cast<double>(poses.size()));
}

TEST(PlaneRefinement, BringsShakenScansTogether) {
  std::mt19937 random(1);
  const Walk& w = walk();
  for (int start = 0; start < 4; ++start) {
    const std::vector<Pose> poses = shaken(w.truth, random, 0.008, radians(0.15));
    const PlaneRefinement result = refine_planes(poses, w.scans);
    EXPECT_TRUE(result.converged);
    EXPECT_TRUE(result.improved) << result.reason;
    EXPECT_LT(result.thickness_after, 0.7 * result.thickness_before);
    EXPECT_GT(result.planes, 30u);
    EXPECT_GT(result.observations, 2 * result.planes);
    EXPECT_GT(result.moved_rms, 0.004);
    EXPECT_GE(result.moved_most, result.moved_rms);
    EXPECT_LT(error(result.poses, w.truth), error(poses, w.truth) / 8);
    EXPECT_EQ(result.poses[0].matrix(), orthonormalized(w.truth[0]).matrix());
  }
}

// What is right stays right, whatever the noise of the scans is.
TEST(PlaneRefinement, LeavesExactPosesWithinAFractionOfTheNoise) {
  double sum = 0;
  constexpr int draws = 4;
  for (int draw = 1; draw <= draws; ++draw) {
    const double noise = draw % 2 == 0 ? 0.005 : 0.015;
    const Walk w = walk_in_room(static_cast<std::uint64_t>(draw), noise);
    const PlaneRefinement result = refine_planes(w.truth, w.scans);
    EXPECT_LT(error(result.poses, w.truth), 0.2 * noise) << draw;
    sum += error(result.poses, w.truth) / noise;
  }
  EXPECT_LT(sum / draws, 0.12);
}

TEST(PlaneRefinement, DoesNotWorsenGoodPoses) {
  std::mt19937 random(2);
  double before = 0, after = 0;
  for (int draw = 1; draw <= 5; ++draw) {
    const Walk w = walk_in_room(static_cast<std::uint64_t>(100 + draw), 0.01);
    const std::vector<Pose> poses = shaken(w.truth, random, 0.001, radians(0.02));
    const PlaneRefinement result = refine_planes(poses, w.scans);
    before += error(poses, w.truth);
    after += error(result.poses, w.truth);
    if (!result.improved) {
      EXPECT_FALSE(result.reason.empty());
      EXPECT_EQ(result.poses[1].matrix(), poses[1].matrix());
    }
  }
  EXPECT_LE(after, before * 1.05 + 1e-4);
}

TEST(PlaneRefinement, MovesWithTheWorld) {
  std::mt19937 random(3);
  const Walk& w = walk();
  const std::vector<Pose> poses = shaken(w.truth, random, 0.005, radians(0.1));
  const Pose motion = random_motion(random, 500, 2);
  std::vector<Pose> moved;
  for (const Pose& pose : poses) moved.push_back(motion * pose);
  const PlaneRefinement here = refine_planes(poses, w.scans);
  const PlaneRefinement there = refine_planes(moved, w.scans);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_LT(shift_between(motion * here.poses[i], there.poses[i]), 1e-5);
    EXPECT_LT(rotation_angle(motion * here.poses[i], there.poses[i]), 1e-5);
  }
}

TEST(PlaneRefinement, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(4);
  const Walk& w = walk();
  const std::vector<Pose> poses = shaken(w.truth, random, 0.005, radians(0.1));
  const auto with = [&](int threads) {
    const testing::ThreadCount count(threads);
    return refine_planes(poses, w.scans);
  };
  const PlaneRefinement one = with(1), many = with(4);
  EXPECT_EQ(one.iterations, many.iterations);
  EXPECT_EQ(one.thickness_after, many.thickness_after);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(one.poses[i].matrix(), many.poses[i].matrix());
}

TEST(PlaneRefinement, DoesNotDependOnTheOrderOfTheScans) {
  std::mt19937 random(5);
  const Walk& w = walk();
  const std::vector<Pose> poses = shaken(w.truth, random, 0.005, radians(0.1));
  const std::vector<Pose> backwards(poses.rbegin(), poses.rend());
  const std::vector<MatchingScan> scans(w.scans.rbegin(), w.scans.rend());
  const std::vector<Pose> here = refine_planes(poses, w.scans, {}, {.tolerance = 1e-5}).poses;
  const std::vector<Pose> there = refine_planes(backwards, scans, {}, {.tolerance = 1e-5}).poses;
  const std::size_t last = poses.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const Pose a = here[i].inverse() * here[last], b = there[last - i].inverse() * there[0];
    EXPECT_LT(shift_between(a, b), 2e-5);
    EXPECT_LT(rotation_angle(a, b), 1e-5);
  }
}

TEST(PlaneRefinement, LeavesTheDirectionOfACorridor) {
  const Building corridor = testing::bare_corridor();
  std::vector<Pose> truth;
  std::vector<MatchingScan> scans;
  for (std::size_t i = 0; i < 4; ++i) {
    truth.push_back(pose_from_xyz_ypr({1.5 * static_cast<double>(i), 0.1, 1.0}, 0.2, 0, 0));
    scans.push_back(matching_scan(scan_of(corridor, truth[i], i)));
  }
  std::vector<Pose> poses = truth;
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i].translation() += Eigen::Vector3d(0.02, i % 2 == 0 ? 0.006 : -0.006, 0.004);
  const PlaneRefinement result = refine_planes(poses, scans);
  EXPECT_TRUE(result.improved) << result.reason;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector3d off = result.poses[i].translation() - truth[i].translation();
    EXPECT_NEAR(off.x(), 0.02, 0.002) << i;
    EXPECT_NEAR(off.y(), 0, 0.001) << i;
    EXPECT_NEAR(off.z(), 0, 0.001) << i;
    EXPECT_LT(degrees(rotation_angle(result.poses[i], truth[i])), 0.05) << i;
  }
}

/// A wall of 4 m by 2 m across the x axis, points 4 cm apart, with some noise.
Cloud wall_at(double x, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 0.003);
  Cloud cloud;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 50; ++j)
      cloud.points.push_back(
          Eigen::Vector3d(x + noise(random), -2 + 0.04 * i, -1 + 0.04 * j).cast<float>());
  return cloud;
}

// Each side of a thin wall is a plane of its own, even where they are nearer than the gate.
TEST(PlaneRefinement, KeepsTheSidesOfAThinWallApart) {
  std::mt19937 random(6);
  for (const double thickness : {0.02, 0.05, 0.08}) {
    const std::vector<MatchingScan> scans = {matching_scan(wall_at(2, random)),
                                             matching_scan(wall_at(2, random))};
    Pose facing_back = pose_from_xyz_ypr({4 + thickness, 0, 0}, pi, 0, 0);
    const std::vector<Pose> poses = {Pose::Identity(), facing_back};
    const std::vector<Surfel> all = surfels(scans, 0.15);
    const std::vector<PlanePatch> patches =
        plane_patches(all, surest_first(all), poses, {}, {.gate = 0.1});
    EXPECT_GT(patches.size(), 8u);
    for (const PlanePatch& patch : patches) {
      for (const std::uint32_t i : patch.surfels)
        EXPECT_EQ(all[i].scan, all[patch.surfels.front()].scan);
      const double side = all[patch.surfels.front()].scan == 0 ? -1 : 1;
      EXPECT_GT(side * patch.plane.normal.x(), 0.99) << "towards its scanner";
    }
    const PlaneRefinement result = refine_planes(poses, scans, {}, {.gate = 0.1});
    EXPECT_FALSE(result.improved);
    EXPECT_EQ(result.reason, "no planes are shared");
    EXPECT_EQ(result.poses[1].matrix(), facing_back.matrix());
  }
}

TEST(PlaneRefinement, CoversEachSurfelOnceAtMost) {
  const Walk& w = walk();
  const std::vector<Surfel> all = surfels(w.scans, 0.15);
  const PatchParams params;
  std::vector<int> uses(all.size(), 0);
  std::size_t held_out = 0, used = 0;
  for (const PlanePatch& patch : plane_patches(all, surest_first(all), w.truth, {}, params)) {
    EXPECT_TRUE(std::is_sorted(patch.surfels.begin(), patch.surfels.end()));
    for (const std::uint32_t i : patch.surfels) {
      ++uses[i];
      const Pose& pose = w.truth[all[i].scan];
      EXPECT_LE(std::abs(patch.plane.signed_distance(pose * all[i].point.cast<double>())),
                params.gate + 1e-5);
      EXPECT_GE(patch.plane.normal.dot(pose.linear() * all[i].normal.cast<double>()),
                std::cos(params.max_angle) - 1e-5);
    }
  }
  EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    held_out += all[i].held_out;
    used += static_cast<std::size_t>(uses[i]);
  }
  EXPECT_GT(used, 0.8 * static_cast<double>(all.size()));
  EXPECT_NEAR(static_cast<double>(held_out) / static_cast<double>(all.size()), 0.25, 0.06);
}

TEST(PlaneRefinement, LeavesScansOfDifferentPartsAlone) {
  std::mt19937 random(7);
  const Walk& w = walk();
  const std::vector<Pose> poses = shaken(w.truth, random, 0.005, radians(0.1));
  const std::vector<std::size_t> parts = {0, 0, 1, 1, 2};
  const PlaneRefinement result = refine_planes(poses, w.scans, parts);
  EXPECT_TRUE(result.improved) << result.reason;
  for (const std::size_t first : {0, 2, 4})
    EXPECT_TRUE(result.poses[first].isApprox(poses[first], 1e-12)) << "fixed: " << first;
  const auto off = [&](const std::vector<Pose>& p, std::size_t a, std::size_t b) {
    return shift_between(p[a].inverse() * p[b], w.truth[a].inverse() * w.truth[b]);
  };
  EXPECT_LT(off(result.poses, 0, 1), 0.4 * off(poses, 0, 1));
  EXPECT_LT(off(result.poses, 2, 3), 0.4 * off(poses, 2, 3));
}

TEST(PlaneRefinement, OfLittleIsWhatCame) {
  const Walk& w = walk();
  const PlaneRefinement nothing = refine_planes({}, {});
  EXPECT_TRUE(nothing.converged);
  EXPECT_TRUE(nothing.poses.empty());
  EXPECT_FALSE(nothing.improved);

  const PlaneRefinement one =
      refine_planes(std::vector{w.truth[0]}, std::span(w.scans).subspan(0, 1));
  EXPECT_TRUE(one.converged);
  EXPECT_EQ(one.reason, "no planes are shared");
  EXPECT_EQ(one.poses[0].matrix(), w.truth[0].matrix());

  // An empty scan, a cloud without planes, and two scans of the room.
  std::mt19937 random(8);
  std::uniform_real_distribution<float> anywhere(-3, 3);
  Cloud mist;
  for (int i = 0; i < 3000; ++i)
    mist.points.emplace_back(anywhere(random), anywhere(random), anywhere(random));
  const std::vector<MatchingScan> scans = {matching_scan({}), w.scans[0], matching_scan(mist),
                                           w.scans[1]};
  std::vector<Pose> poses = {w.truth[2], w.truth[0], w.truth[1], w.truth[1]};
  poses[3].translation().x() += 0.005;
  const PlaneRefinement some = refine_planes(poses, scans);
  EXPECT_TRUE(some.improved) << some.reason;
  for (const std::size_t i : {0, 1, 2}) EXPECT_LT(shift_between(some.poses[i], poses[i]), 1e-4);
  EXPECT_LT(shift_between(some.poses[3], w.truth[1]), 0.001);
}

TEST(PlaneRefinement, RefusesBadInput) {
  const Walk& w = walk();
  EXPECT_EQ(message_of([&] { refine_planes({}, w.scans); }),
            "plane refinement: the number of poses must be that of the scans, got 0");
  EXPECT_EQ(message_of([&] { refine_planes(w.truth, w.scans, std::vector<std::size_t>(3)); }),
            "plane refinement: the number of parts must be that of the scans, or 0, got 3");
  EXPECT_EQ(message_of([&] { refine_planes(w.truth, w.scans, {}, {.spacing = 0}); }),
            "plane refinement: spacing must be > 0 m, got 0");
  EXPECT_EQ(message_of([&] { refine_planes(w.truth, w.scans, {}, {.max_rounds = 0}); }),
            "plane refinement: max_rounds must be > 0, got 0");
  std::vector<Pose> poses = w.truth;
  poses[2].translation().z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message_of([&] { refine_planes(poses, w.scans); }),
            "plane refinement: pose 2 is not finite");
}

/// Scans of some random planes, with points that are `noise` off them.
struct RandomPlanes {
  std::vector<Pose> poses;
  std::vector<SharedPlane> planes;
};

RandomPlanes random_planes(std::mt19937& random, double noise) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> weight(0.2, 1);
  RandomPlanes result;
  for (int i = 0; i < 4; ++i) result.poses.push_back(random_motion(random, 2, 1));
  for (int p = 0; p < 8; ++p) {
    const Pose world_from_plane = random_motion(random, 4, 2);
    SharedPlane plane;
    for (std::size_t s = 0; s < result.poses.size(); ++s) {
      if ((p + static_cast<int>(s)) % 4 == 3) continue;  // not all see all
      PlaneObservation observation{.scan = s, .moments = {}};
      for (int k = 0; k < 20; ++k) {
        const Eigen::Vector3d point(normal(random), normal(random), noise * normal(random));
        const Eigen::Vector3d in_scan = result.poses[s].inverse() * (world_from_plane * point);
        if (k == 0) observation.origin = in_scan;
        observation.moments.add(in_scan - observation.origin, weight(random));
      }
      plane.push_back(observation);
    }
    result.planes.push_back(plane);
  }
  return result;
}

TEST(PlaneSystem, HasTheDerivativesOfTheSquaredDistances) {
  std::mt19937 random(9);
  for (const double noise : {0.0, 0.05}) {
    const RandomPlanes r = random_planes(random, noise);
    const std::vector<double> radius(r.poses.size(), 3);
    const Eigen::Index size = 6 * static_cast<Eigen::Index>(r.poses.size());
    const auto value = [&](const Eigen::VectorXd& x) {
      std::vector<Pose> poses = r.poses;
      for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i] = exp_se3(x.segment<6>(6 * static_cast<Eigen::Index>(i))) * poses[i];
      return squared_distances(r.planes, poses) / 2;
    };
    PlaneSystem system(r.planes, r.poses.size());
    system.linearize(r.planes, r.poses, r.poses, radius, 0);
    const double h = noise > 0 ? 1e-6 : 1e-4;
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::VectorXd x = h * Eigen::VectorXd::Unit(size, i);
      EXPECT_NEAR((value(x) - value(-x)) / (2 * h), system.gradient()[i], 2e-5) << i;
    }
    if (noise > 0) continue;
    // Where the points are on the planes, Gauss-Newton has the second derivatives too.
    const Eigen::MatrixXd hessian = system.dense_hessian();
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) {
        const Eigen::VectorXd x = h * Eigen::VectorXd::Unit(size, i),
                              y = h * Eigen::VectorXd::Unit(size, j);
        const double numeric =
            (value(x + y) - value(x - y) - value(y - x) + value(-x - y)) / (4 * h * h);
        EXPECT_NEAR(numeric, hessian(i, j), 1e-3 + 1e-4 * std::abs(hessian(i, j))) << i << " " << j;
      }
    // A motion of the whole world changes nothing.
    Eigen::VectorXd together(size);
    for (Eigen::Index i = 0; i < size; ++i) together[i] = 1.0 + static_cast<double>(i % 6);
    EXPECT_LT((hessian * together).norm(), 1e-9 * hessian.norm() * together.norm());
  }
}

TEST(PlaneSystem, FindsTheWayBackInOneStep) {
  std::mt19937 random(10);
  const RandomPlanes r = random_planes(random, 0);
  std::vector<Pose> poses = r.poses;
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i] = exp_se3(log_se3(random_motion(random, 1e-4, 1e-4))) * poses[i];
  PlaneSystem system(r.planes, poses.size());
  system.linearize(r.planes, poses, poses, std::vector<double>(poses.size(), 3.0), 0);
  const auto motions = system.solved();
  ASSERT_TRUE(motions);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT(shift_between(exp_se3((*motions)[i]) * poses[i], r.poses[i]), 1e-6);
}

}  // namespace
}  // namespace planum
