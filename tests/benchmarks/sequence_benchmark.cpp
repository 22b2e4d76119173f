// A building whose corridor is a ring, rooms entered and left, odometry that is off by metres when
// the ring closes: scans registered, loops closed, relaxed. Time by step, error of the path, and
// how far the walls seen at the start and at the end lie apart. Options: --help
#include <algorithm>
#include <chrono>
#include <ctime>
#include <random>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "slam/evaluation/double_walls.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/graph/graph_optimization.hpp"
#include "slam/graph/loop_candidates.hpp"
#include "slam/graph/loop_verification.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/path_covariance.hpp"
#include "slam/graph/plane_refinement.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/range_limits.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/benchmarks/ring_building.hpp"
#include "tests/support/numbered.hpp"

namespace {

using namespace planum;

/// What the user chooses.
struct Case {
  std::uint64_t seed = 1;
  double drift = 1, step = 2.2, false_share = 0;
  std::size_t visits = 8, slices = SimulatorParams{}.slices;
};

void add_options(CLI::App& app, Case& chosen) {
  app.add_option("--seed", chosen.seed, "of noise and drift");
  app.add_option("--drift", chosen.drift, "of the odometry, in multiples of the usual one");
  app.add_option("--step", chosen.step, "m, between stops in the corridor");
  app.add_option("--visits", chosen.visits, "rooms that are entered");
  app.add_option("--slices", chosen.slices, "of a scan, 361 beams each");
  app.add_option("--false", chosen.false_share, "so many false loops for each right one");
}

/// Time on the wall and of all processors so far, s.
struct Time {
  double wall, processor;
};

Time now() {
  using std::chrono::steady_clock;
  return {std::chrono::duration<double>(steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

void print_time(const char* what, const Time& from, const Time& to) {
  fmt::print("{:10} {:6.2f} s, processors {:6.2f} s\n", what, to.wall - from.wall,
             to.processor - from.processor);
}

void print_error(const char* what, const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
  const TrajectoryError error =
      trajectory_error(testing::numbered(poses), testing::numbered(truth));
  fmt::print("{:10} {:8.1f} mm rmse, {:8.1f} mm at most, {:6.3f} deg on average\n", what,
             1000 * error.ape_translation.rmse, 1000 * error.ape_translation.max,
             error.ape_rotation.mean);
}

/// Points and normals of scans begin to end (not included), in the world.
Cloud surfaces(std::span<const MatchingScan> scans, const std::vector<Pose>& poses,
               std::size_t begin, std::size_t end) {
  Cloud result;
  for (std::size_t i = begin; i < end; ++i) {
    Cloud own;
    own.points = scans[i].points;
    for (const LocalPlane& plane : scans[i].planes) own.normals.push_back(plane.normal);
    own = transformed(own, poses[i]);
    result.points.insert(result.points.end(), own.points.begin(), own.points.end());
    result.normals.insert(result.normals.end(), own.normals.begin(), own.normals.end());
  }
  return result;
}

/// The first scans against the last ones, which see the same walls again.
void print_walls(const char* what, std::span<const MatchingScan> scans,
                 const std::vector<Pose>& poses) {
  const DoubleWallGap gap = double_wall_gap(
      double_walls(surfaces(scans, poses, 0, 3),
                   surfaces(scans, poses, scans.size() - 3, scans.size()), {.max_patches = 500}));
  fmt::print("{:10} walls before and after the loop {:.1f} mm apart (median), {:.1f} mm (90 %)\n",
             what, 1000 * gap.median, 1000 * gap.percentile_90);
}

/// What a loop itself says about its error (nothing along the directions in which it slides), and
/// what scans may be bent.
Matrix6d believed_covariance(const Edge& loop) {
  const Matrix6d information = loop.information + Matrix6d(1e-2 * Matrix6d::Identity());
  return information.llt().solve(Matrix6d::Identity()) + step_noise(LoopParams{});
}

std::size_t accepted_loops(const PoseGraph& graph) {
  std::size_t count = 0;
  for (const Edge& edge : graph.edges) count += edge.kind == EdgeKind::loop && edge.accepted;
  return count;
}

/// So many false loops for each right one: random pairs of scans that claim to be a metre apart at
/// most, as sure of it as the right ones.
void add_false_loops(PoseGraph& graph, double share, std::uint64_t seed) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(accepted_loops(graph)));
  Matrix6d information = Matrix6d::Zero();
  for (const Edge& edge : graph.edges)
    if (edge.kind == EdgeKind::loop && edge.accepted) information = edge.information;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<std::size_t> scan(0, graph.poses.size() - 1);
  std::uniform_real_distribution<double> shift(-1, 1), turn(-pi, pi);
  for (std::size_t k = 0; k < count;) {
    const std::size_t one = scan(random), other = scan(random);
    const auto [from, to] = std::minmax(one, other);
    if (to < from + 10) continue;
    graph.edges.push_back(
        {.from = from,
         .to = to,
         .from_from_to = pose_from_xyz_ypr({shift(random), shift(random), 0}, turn(random), 0, 0),
         .information = information,
         .kind = EdgeKind::loop});
    ++k;
  }
}

}  // namespace

int main(int argc, char** argv) {
  Case chosen;
  CLI::App app("Registration of a walk round a ring of corridors");
  add_options(app, chosen);
  CLI11_PARSE(app, argc, argv);
  const auto& [seed, drift, step, false_share, visits, slices] = chosen;
  const auto [building, truth] = testing::ring_building(step, visits);
  const auto simulated =
      simulate_scans(building.mesh.mesh, truth, {.slices = slices, .seed = seed});
  std::vector<Cloud> clouds;
  std::size_t points = 0;
  for (const SimulatedScan& scan : simulated) {
    clouds.push_back(points_from_slices(scan.scan).cloud);
    points += clouds.back().points.size();
  }
  const std::vector<Pose> odometry = drifted(truth, {.translation_per_metre = 0.02 * drift,
                                                     .heading_per_metre = 0.004 * drift,
                                                     .heading_per_radian = 0.01 * drift,
                                                     .heading_bias_per_metre = 0.0006 * drift,
                                                     .seed = seed});
  fmt::print("{} scans, {} points, seed {}\n", truth.size(), points, seed);
  const auto closure = [&](const std::vector<Pose>& poses) {
    const Pose error = (truth.front().inverse() * truth.back()).inverse() *
                       (poses.front().inverse() * poses.back());
    return error.translation().norm();
  };
  fmt::print("odometry off by {:.2f} m at the end\n", closure(odometry));
  print_error("odometry", odometry, truth);

  const Time start = now();
  std::vector<std::optional<MatchingScan>> ready(clouds.size());
  parallel_for(clouds.size(), 1,
               [&](std::size_t i, std::size_t) { ready[i] = matching_scan(clouds[i]); });
  std::vector<MatchingScan> scans;
  for (auto& scan : ready) scans.push_back(std::move(*scan));
  const Time made_ready = now();
  const SequenceMatch sequence = match_in_order(odometry, icp_matcher(scans));
  const Time matched = now();
  print_error("matched", sequence.poses, truth);
  PoseGraph graph = pose_graph(sequence);
  const std::vector<Edge> loops = find_loops(scans, graph, icp_gated_matcher(scans));
  graph.edges.insert(graph.edges.end(), loops.begin(), loops.end());
  const Time closed = now();
  if (false_share > 0) {
    const std::size_t accepted_before = accepted_loops(graph), first = graph.edges.size();
    add_false_loops(graph, false_share, seed);
    const auto counts = optimize(graph, {.covariances = false}).quality.counts;
    std::size_t kept = 0, dropped = 0;
    for (std::size_t k = 0; k < graph.edges.size(); ++k) {
      Edge& edge = graph.edges[k];
      if (k >= first) kept += counts[k];
      if (k < first && edge.accepted) dropped += !counts[k];
      edge.accepted = counts[k];
    }
    fmt::print("{} false loops among {}: {} kept, {} right ones dropped\n",
               graph.edges.size() - first, accepted_before, kept, dropped);
  }
  const GraphResult result = relax_lu_milios(graph, scans);
  const Time relaxed = now();
  print_error("relaxed", result.graph.poses, truth);
  const PlaneRefinement refinement =
      refine_planes(result.graph.poses, scans, components(result.graph).of_pose);
  const Time refined = now();
  print_error("refined", refinement.poses, truth);
  print_walls("matched", scans, sequence.poses);
  print_walls("relaxed", scans, result.graph.poses);
  print_walls("refined", scans, refinement.poses);
  print_walls("truth", scans, truth);

  std::size_t unmatched = 0, accepted = 0, wrong = 0;
  for (const SequenceStep& way : sequence.steps) unmatched += !way.matched;
  for (const Edge& loop : loops) {
    if (!loop.accepted) continue;
    ++accepted;
    const Vector6d error =
        log_se3((truth[loop.from].inverse() * truth[loop.to]).inverse() * loop.from_from_to);
    const double off = deviation(error, believed_covariance(loop));
    if (off <= LoopParams{}.max_deviation) continue;
    ++wrong;
    fmt::print("loop {} to {} is off by {:.3f} m, {:.2f} deg, {:.1f} standard deviations\n",
               loop.from, loop.to, error.head<3>().norm(), degrees(error.tail<3>().norm()), off);
  }
  fmt::print("{} steps not matched; {} loops accepted, {} of them wrong, {} rejected\n", unmatched,
             accepted, wrong, loops.size() - accepted);
  print_time("made ready", start, made_ready);
  print_time("matched", made_ready, matched);
  print_time("loops", matched, closed);
  print_time("relaxed", closed, relaxed);
  print_time("all", start, relaxed);
  print_time("refined", relaxed, refined);
}
