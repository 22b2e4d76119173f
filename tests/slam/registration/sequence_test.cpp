#include "slam/registration/sequence.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::random_motion;
using testing::scan_of;
using testing::shift_between;
using testing::Walk;

/// Some stops in the room.
Walk walk() {
  std::vector<Pose> truth;
  for (int i = 0; i < 4; ++i)
    truth.push_back(pose_from_xyz_ypr({1.0 + 0.4 * i, 1.2 + 0.3 * i, 1}, 0.3 * i, 0, 0));
  return testing::walk_in_room(std::move(truth));
}

std::vector<Pose> drifting(const std::vector<Pose>& truth, std::mt19937& random) {
  std::vector<Pose> odometry = {truth.front()};
  for (std::size_t i = 1; i < truth.size(); ++i)
    odometry.push_back(odometry.back() * truth[i - 1].inverse() * truth[i] *
                       random_motion(random, 0.1, radians(3)));
  return odometry;
}

TEST(Sequence, FollowsTheWayFromDriftingOdometry) {
  const Walk w = walk();
  std::mt19937 random(1);
  const SequenceMatch match = match_in_order(drifting(w.truth, random), icp_matcher(w.scans));
  ASSERT_EQ(match.poses.size(), w.truth.size());
  for (std::size_t i = 0; i < w.truth.size(); ++i) {
    EXPECT_LT(shift_between(match.poses[i], w.truth[i]), 0.006);
    EXPECT_LT(rotation_angle(match.poses[i], w.truth[i]), radians(0.15));
  }
  for (const SequenceStep& step : match.steps) EXPECT_TRUE(step.matched) << step.reason;
}

TEST(Sequence, MovesWithTheWorld) {
  const Walk w = walk();
  std::mt19937 random(2);
  const std::vector<Pose> odometry = drifting(w.truth, random);
  const Pose motion = random_motion(random, 50, 2);
  std::vector<Pose> moved = odometry;
  for (Pose& pose : moved) pose = motion * pose;
  const SequenceMatch here = match_in_order(odometry, icp_matcher(w.scans));
  const SequenceMatch there = match_in_order(moved, icp_matcher(w.scans));
  for (std::size_t i = 0; i < here.poses.size(); ++i)
    EXPECT_LT(shift_between(motion * here.poses[i], there.poses[i]), 1e-5);
}

TEST(Sequence, KeepsOdometryWhereNothingOverlaps) {
  Walk w = walk();
  // The last scan is of somewhere else.
  w.scans[3] =
      matching_scan(scan_of(testing::bare_corridor(), pose_from_xyz_ypr({0, 0, 1}, 0, 0, 0), 9));
  SequenceParams params;
  params.min_overlap = 0.5;
  const SequenceMatch match = match_in_order(w.truth, icp_matcher(w.scans), params);
  const SequenceStep& last = match.steps.back();
  EXPECT_FALSE(last.matched);
  EXPECT_NE(last.reason.find("is below 0.50"), std::string::npos) << last.reason;
  const Pose step = w.truth[2].inverse() * w.truth[3];
  EXPECT_LT(shift_between(last.alignment.target_from_source, step), 1e-9);
  EXPECT_EQ(last.alignment.information, odometry_information(step));
  EXPECT_EQ(last.odometry_information, odometry_information(step));
}

TEST(Sequence, DoesNotBelieveAMatchThatWentAstray) {
  const std::vector<Pose> odometry(2, Pose::Identity());
  const auto astray = [](double shift, double angle, bool converged) {
    return [=](std::size_t, std::size_t, const Pose& guess) {
      Alignment alignment{.target_from_source =
                              guess * Pose(Eigen::Translation3d(shift, 0, 0)) *
                              Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()))};
      alignment.pairs = 1000;
      alignment.overlap = 0.8;
      alignment.converged = converged;
      return alignment;
    };
  };
  const auto reason = [&](const PairMatcher& matcher) {
    return match_in_order(odometry, matcher).steps.front().reason;
  };
  EXPECT_EQ(reason(astray(0.1, 0.1, true)), "");
  EXPECT_EQ(reason(astray(0.1, 0.1, false)), "the match did not converge");
  EXPECT_EQ(reason(astray(2.5, 0.1, true)), "moved 2.50 m, more than 2.00 m");
  EXPECT_EQ(reason(astray(0.1, 1.0, true)), "turned 57.3 deg, more than 45.0 deg");
}

TEST(Sequence, StartsEachStepFromOdometryMovedByTheLastCorrection) {
  std::mt19937 random(3);
  std::vector<Pose> odometry;
  for (int i = 0; i < 4; ++i) odometry.push_back(random_motion(random, 2, 1));
  std::vector<std::pair<std::size_t, std::size_t>> asked;
  const Pose correction = random_motion(random, 0.1, 0.05);
  const SequenceMatch match =
      match_in_order(odometry, [&](std::size_t target, std::size_t source, const Pose& guess) {
        asked.emplace_back(target, source);
        EXPECT_TRUE(guess.isApprox(odometry[target].inverse() * odometry[source]));
        Alignment alignment{.target_from_source = guess * correction};
        alignment.pairs = 100;
        alignment.overlap = 1;
        alignment.converged = true;
        return alignment;
      });
  EXPECT_EQ(asked, (std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}, {2, 3}}));
  Pose expected = odometry[0];
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    expected = expected * odometry[i - 1].inverse() * odometry[i] * correction;
    EXPECT_TRUE(match.poses[i].isApprox(expected, 1e-9));
  }
}

TEST(Sequence, HasNoStepsForNoneOrOneScan) {
  const PairMatcher never = [](std::size_t, std::size_t, const Pose&) -> Alignment {
    ADD_FAILURE();
    return {};
  };
  EXPECT_TRUE(match_in_order({}, never).poses.empty());
  const std::vector<Pose> one(1, Pose(Eigen::Translation3d(1, 2, 3)));
  EXPECT_TRUE(match_in_order(one, never).poses[0].isApprox(one[0]));
}

TEST(Sequence, TakesEmptyScansForUnmatched) {
  const std::vector<MatchingScan> scans = {matching_scan({}), matching_scan({})};
  const std::vector<Pose> odometry = {Pose::Identity(), Pose(Eigen::Translation3d(1, 0, 0))};
  const SequenceMatch match = match_in_order(odometry, icp_matcher(scans));
  EXPECT_EQ(match.steps[0].reason, "too few pairs");
  EXPECT_TRUE(match.poses[1].isApprox(odometry[1]));
}

TEST(Sequence, RefusesPosesThatAreNotFinite) {
  std::vector<Pose> odometry(3, Pose::Identity());
  odometry[1].translation().y() = std::nan("");
  EXPECT_EQ(message_of([&] { match_in_order(odometry, PairMatcher{}); }),
            "registration: the pose of scan 1 of the sequence is not finite");
  EXPECT_NE(message_of([&] {
              match_in_order(std::vector<Pose>{}, PairMatcher{}, {.min_overlap = 2});
            }).find("min_overlap must be between 0 and 1, got 2"),
            std::string::npos);
}

/// A match of good quality, `shift` along x from the guess.
Alignment good(const Pose& guess, double shift) {
  Alignment alignment{.target_from_source = guess * Pose(Eigen::Translation3d(shift, 0, 0))};
  alignment.pairs = 1000;
  alignment.overlap = 0.8;
  alignment.converged = true;
  return alignment;
}

TEST(Sequence, TriesAgainInOrderWhereAMatchCannotBeTrusted) {
  const std::vector<Pose> odometry(2, Pose::Identity());
  const PairMatcher fails = [](std::size_t, std::size_t, const Pose& guess) {
    return Alignment{.target_from_source = guess};
  };
  const auto shift_with = [&](const SequenceAids& aids) {
    const SequenceStep step = match_in_order(odometry, fails, {}, {}, aids).steps.front();
    EXPECT_EQ(step.matched, step.reason.empty());
    return step.alignment.target_from_source.translation().x();
  };
  SequenceAids aids;
  EXPECT_EQ(shift_with(aids), 0);
  aids.locate = [](std::size_t target, std::size_t source) -> std::optional<Alignment> {
    EXPECT_EQ(target + 1, source);
    return good(Pose::Identity(), 0.3);
  };
  EXPECT_EQ(shift_with(aids), 0.3);
  aids.metascan = [](std::span<const Pose> earlier, const Pose& guess, double gate) {
    EXPECT_EQ(earlier.size(), 1u);
    EXPECT_EQ(gate, SequenceParams{}.second_gate);
    return good(guess, 0.2);
  };
  EXPECT_EQ(shift_with(aids), 0.2);
  aids.second = [](std::size_t, std::size_t, const Pose& guess, double) {
    return good(guess, 0.1);
  };
  EXPECT_EQ(shift_with(aids), 0.1);
  aids.second = [](std::size_t, std::size_t, const Pose& guess, double) {
    Alignment alignment = good(guess, 0.1);
    alignment.overlap = 0.2;  // enough at once, not at a second attempt
    return alignment;
  };
  EXPECT_EQ(shift_with(aids), 0.2);
}

TEST(Sequence, PrefersAMatchOfMoreOverlapToOneOfLittle) {
  const std::vector<Pose> odometry(2, Pose::Identity());
  const PairMatcher thin = [](std::size_t, std::size_t, const Pose& guess) {
    Alignment alignment = good(guess, 0.1);
    alignment.overlap = 0.2;
    return alignment;
  };
  const auto shift_with = [&](double overlap) {
    SequenceAids aids;
    aids.metascan = [=](std::span<const Pose>, const Pose& guess, double) {
      Alignment alignment = good(guess, 0.2);
      alignment.overlap = overlap;
      return alignment;
    };
    const SequenceStep step = match_in_order(odometry, thin, {}, {}, aids).steps.front();
    EXPECT_TRUE(step.matched) << step.reason;
    return step.alignment.target_from_source.translation().x();
  };
  EXPECT_EQ(shift_with(0.5), 0.2);
  EXPECT_EQ(shift_with(0.25), 0.1) << "it is no better";
}

TEST(Sequence, DoesNotBelieveAMatchWhoseRaysGoThroughSurfaces) {
  const std::vector<Pose> odometry(2, Pose::Identity());
  const PairMatcher matcher = [](std::size_t, std::size_t, const Pose& guess) {
    return good(guess, 0.1);
  };
  SequenceAids aids;
  aids.contradicted = [](std::size_t, std::size_t, const Pose& pose) {
    return pose.translation().x() > 0.05 ? 0.3 : 0.0;
  };
  const SequenceStep step = match_in_order(odometry, matcher, {}, {}, aids).steps.front();
  EXPECT_FALSE(step.matched);
  EXPECT_EQ(step.reason, "rays of one scan go through 30 % of the other's surfaces");
}

TEST(Sequence, WithoutOdometryMayEndAnywhere) {
  const std::vector<Pose> odometry(2, Pose::Identity());
  const PairMatcher matcher = [](std::size_t, std::size_t, const Pose& guess) {
    return good(guess, 5);
  };
  EXPECT_FALSE(match_in_order(odometry, matcher).steps.front().matched);
  EXPECT_TRUE(match_in_order(odometry, matcher, {.odometry_known = false}).steps.front().matched);
}

TEST(Sequence, FollowsTheWayOnAMetascan) {
  const Walk w = walk();
  std::mt19937 random(4);
  const SequenceMatch match =
      match_to_metascan(drifting(w.truth, random), icp_metascan_matcher(w.scans));
  for (std::size_t i = 0; i < w.truth.size(); ++i)
    EXPECT_LT(shift_between(match.poses[i], w.truth[i]), 0.006);
  for (const SequenceStep& step : match.steps) EXPECT_TRUE(step.matched) << step.reason;
}

TEST(OdometryInformation, GrowsWeakerWithTheWay) {
  const Matrix6d near = odometry_information(Pose(Eigen::Translation3d(0.1, 0, 0)));
  const Matrix6d far = odometry_information(Pose(Eigen::Translation3d(10, 0, 0)));
  EXPECT_GT(near(0, 0), far(0, 0));
  EXPECT_GT(near(5, 5), far(5, 5));
  EXPECT_NEAR(1 / std::sqrt(far(0, 0)), std::hypot(0.05, 1.0), 1e-12);
}

}  // namespace
}  // namespace planum
