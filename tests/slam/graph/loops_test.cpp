#include "slam/graph/loops.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::shift_between;

struct Walk : testing::Walk {
  PoseGraph graph;
};

/// Stops in the room that come back to where they began, with poses that drifted on the way and are
/// known to 5 cm at each step.
Walk walk(double drift) {
  Walk w{testing::walk_in_room({pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.5, 0, 0),
                                pose_from_xyz_ypr({1.8, 1.4, 1.0}, 1.2, 0, 0),
                                pose_from_xyz_ypr({2.0, 3.0, 1.0}, 2.4, 0, 0),
                                pose_from_xyz_ypr({1.2, 1.6, 1.0}, 0.6, 0, 0)}),
         {}};
  for (std::size_t i = 0; i < w.truth.size(); ++i)
    w.graph.poses.push_back(Pose(Eigen::Translation3d(drift * static_cast<double>(i), 0, 0)) *
                            w.truth[i]);
  for (std::size_t i = 1; i < w.truth.size(); ++i)
    w.graph.edges.push_back({.from = i - 1,
                             .to = i,
                             .from_from_to = w.graph.poses[i - 1].inverse() * w.graph.poses[i],
                             .information = 400 * Matrix6d::Identity(),
                             .rms = 0.003});
  return w;
}

TEST(Loops, AreFoundWhereThePathComesBack) {
  const Walk w = walk(0.05);
  const std::vector<Edge> loops = find_loops(w.scans, w.graph, icp_gated_matcher(w.scans));
  ASSERT_FALSE(loops.empty());
  bool closed = false;
  for (const Edge& loop : loops) {
    EXPECT_EQ(loop.kind, EdgeKind::loop);
    EXPECT_GT(loop.to, loop.from + 1);
    if (!loop.accepted) continue;
    EXPECT_TRUE(loop.reason.empty());
    EXPECT_LT(shift_between(loop.from_from_to, w.truth[loop.from].inverse() * w.truth[loop.to]),
              0.01);
    closed = closed || (loop.from == 0 && loop.to == 3);
  }
  EXPECT_TRUE(closed);
}

TEST(Loops, AreTheSameForAnyNumberOfThreads) {
  const Walk w = walk(0.05);
  const auto with = [&](int threads) {
    const testing::ThreadCount count(threads);
    return find_loops(w.scans, w.graph, icp_gated_matcher(w.scans));
  };
  const std::vector<Edge> one = with(1), many = with(4);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].from_from_to.matrix(), many[i].from_from_to.matrix());
    EXPECT_EQ(one[i].accepted, many[i].accepted);
  }
}

/// A matcher that answers what it is told, wherever it is asked.
GatedPairMatcher answer(double shift, double overlap, double rms, bool converged = true) {
  return [=](std::size_t, std::size_t, const Pose& guess, double) {
    Alignment alignment{.target_from_source = guess * Pose(Eigen::Translation3d(shift, 0, 0)),
                        .information = 1e6 * Matrix6d::Identity()};
    alignment.rms = rms;
    alignment.overlap = overlap;
    alignment.pairs = 1000;
    alignment.converged = converged;
    return alignment;
  };
}

TEST(Loops, AreRejectedWithAReason) {
  const Walk w = walk(0);
  const auto reason = [&](const GatedPairMatcher& matcher) {
    const std::vector<Edge> loops = find_loops(w.scans, w.graph, matcher);
    EXPECT_FALSE(loops.empty());
    for (const Edge& loop : loops) EXPECT_EQ(loop.accepted, loop.reason.empty());
    return loops.empty() ? std::string() : loops.front().reason;
  };
  EXPECT_EQ(reason(answer(0.01, 0.6, 0.003)), "");
  EXPECT_EQ(reason(answer(0.01, 0.1, 0.003)), "overlap 0.10 is below 0.25");
  EXPECT_EQ(reason(answer(0.01, 0.6, 0.02)), "rms 0.0200 m is above 0.0075 m");
  EXPECT_EQ(reason(answer(0.01, 0.6, 0.003, false)), "the match did not converge");
  EXPECT_NE(reason(answer(3, 0.6, 0.003)).find("3.00 m and 0.0 deg off the path"),
            std::string::npos);
}

TEST(Loops, ThatOthersContradictAreDropped) {
  const Walk w = walk(0);
  // 0-2 and 1-3 as the path has them; 0-3 off by what the path alone would still believe.
  const GatedPairMatcher matcher = [&](std::size_t target, std::size_t source, const Pose& guess,
                                       double gate) {
    return answer(source - target == 3 ? 0.25 : 0.0, 0.6, 0.003)(target, source, guess, gate);
  };
  PoseGraph unsure_in_the_middle = w.graph;
  for (Edge& edge : unsure_in_the_middle.edges) edge.information *= 10000;
  unsure_in_the_middle.edges[1].information /= 10000;
  LoopParams params;
  params.max_deviation = 5;
  const std::vector<Edge> loops = find_loops(w.scans, unsure_in_the_middle, matcher, params);
  for (const Edge& loop : loops) {
    if (loop.to - loop.from == 3) {
      EXPECT_FALSE(loop.accepted);
    } else {
      EXPECT_TRUE(loop.accepted) << loop.from << "-" << loop.to << " " << loop.reason;
    }
  }
}

TEST(Loops, AreRejectedWhereAnotherPlaceFitsAsWell) {
  // Two places 0.8 m apart along x; the start decides.
  const Walk w = walk(0);
  PoseGraph unsure = w.graph;
  for (Edge& edge : unsure.edges) edge.information = 4 * Matrix6d::Identity();
  const GatedPairMatcher matcher = [&](std::size_t target, std::size_t source, const Pose& guess,
                                       double gate) {
    const Pose path = w.graph.poses[target].inverse() * w.graph.poses[source];
    const Pose off = path.inverse() * guess;
    const double place = off.translation().norm() > 0.3 ? 0.8 : 0.0;
    return answer(0, 0.6, 0.003)(target, source, path * Pose(Eigen::Translation3d(place, 0, 0)),
                                 gate);
  };
  LoopParams params;
  params.max_contradicted = 1;
  const std::vector<Edge> loops = find_loops(w.scans, unsure, matcher, params);
  ASSERT_FALSE(loops.empty());
  for (const Edge& loop : loops) {
    EXPECT_FALSE(loop.accepted);
    EXPECT_EQ(loop.reason, "a place 0.80 m and 0.0 deg from there fits as well");
  }
}

TEST(Loops, AreRejectedWhereRaysGoThroughSurfaces) {
  const Walk w = walk(0);
  PoseGraph unsure = w.graph;
  for (Edge& edge : unsure.edges) edge.information = 4 * Matrix6d::Identity();
  for (const Edge& loop : find_loops(w.scans, unsure, answer(1.2, 0.6, 0.003))) {
    EXPECT_FALSE(loop.accepted);
    EXPECT_NE(loop.reason.find("rays of one scan go through"), std::string::npos) << loop.reason;
  }
}

TEST(Loops, AreNotLookedForFarAway) {
  Walk w = walk(0);
  w.graph.poses[3] = Pose(Eigen::Translation3d(30, 0, 0)) * w.graph.poses[3];
  w.graph.edges[2].from_from_to = w.graph.poses[2].inverse() * w.graph.poses[3];
  const GatedPairMatcher matcher = [](std::size_t, std::size_t source, const Pose& guess,
                                      double gate) {
    EXPECT_NE(source, 3u);
    return answer(0, 0.6, 0.003)(0, 0, guess, gate);
  };
  find_loops(w.scans, w.graph, matcher);
}

TEST(Loops, NeedScansThatSeeSomething) {
  Walk w = walk(0);
  for (MatchingScan& scan : w.scans) scan = matching_scan({});
  EXPECT_TRUE(find_loops(w.scans, w.graph, icp_gated_matcher(w.scans)).empty());
  EXPECT_TRUE(find_loops({}, {}, icp_gated_matcher({})).empty());
}

TEST(Loops, RefuseBadInput) {
  const Walk w = walk(0);
  EXPECT_NE(message_of([&] {
              find_loops(w.scans, {}, icp_gated_matcher(w.scans));
            }).find("loops: the number of poses must be that of the scans, got 0"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              find_loops(w.scans, w.graph, icp_gated_matcher(w.scans), {.min_overlap = 0});
            }).find("loops: min_overlap must be between 0 and 1, got 0"),
            std::string::npos);
}

}  // namespace
}  // namespace planum
