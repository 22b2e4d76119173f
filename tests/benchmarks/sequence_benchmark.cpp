// A building whose corridor is a ring, rooms entered and left, odometry that is off by metres when
// the ring closes: scans registered, loops closed, relaxed. Time by step and error of the path.
//
// usage: sequence_benchmark [SEED [DRIFT [STEP]]]   DRIFT: in multiples of the usual one; STEP: m,
// between stops in the corridor
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <vector>

#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/furniture.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/range_limits.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/support/numbered.hpp"

namespace {

using namespace planum;

constexpr double length = 30, width = 18, corridor = 2.0;  // m, the ring's outer walls
constexpr double wall = 0.15;

PlanPolygon rectangle(double x0, double y0, double x1, double y1) {
  return {.outer = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

/// Four rooms south and four north of the ring; door x, and the side the room lies on.
struct Entrance {
  double x, y, outwards;
};

BuildingPlan ring_plan(std::vector<Entrance>& entrances) {
  BuildingPlan plan{.name = "ring"};
  PlanPolygon ring = rectangle(0, 0, length, width);
  ring.holes.push_back(rectangle(corridor, corridor, length - corridor, width - corridor).outer);
  plan.rooms.push_back({"corridor", ring, 2.6});
  for (int k = 0; k < 8; ++k) {
    const bool south = k < 4;
    const double x0 = 0.5 + 7.3 * (k % 4), x1 = x0 + 6.2 + 0.2 * (k % 3);
    const double depth = 4.0 + 0.3 * k;
    const double near = south ? -wall : width + wall;
    const double far = south ? near - depth : near + depth;
    const std::string name = fmt::format("room {}", k + 1);
    plan.rooms.push_back(
        {name, rectangle(x0, std::min(near, far), x1, std::max(near, far)), 2.5 + 0.1 * (k % 4)});
    const double door = x0 + 1.2 + 0.5 * (k % 4), at = south ? -wall / 2 : width + wall / 2;
    plan.doors.push_back({{"corridor", name}, {door, at}, 0.9, 2.05});
    entrances.push_back({door, at, south ? -1.0 : 1.0});
    const auto add = [&](const std::vector<Box>& boxes) {
      plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
    };
    const double middle = (near + far) / 2;
    add(table({x1 - 1.2, middle}, {1.4, 0.8}, 0.3 * k));
    add(chair({x1 - 2.2, middle + 0.6}, 0.9 * k));
    add(cabinet({x0 + 0.3, middle}, {0.4, 1.2}, 1.0 + 0.15 * k));
  }
  for (int k = 0; k < 5; ++k) {  // something to hold on to in the corridor
    plan.furniture.push_back({{4.0 + 5.3 * k, corridor - 0.15, 0}, {0.9, 0.3, 0.8 + 0.1 * k}});
    plan.furniture.push_back({{6.5 + 4.4 * k, width - corridor + 0.15, 0}, {0.6, 0.3, 1.2}});
  }
  return plan;
}

/// Round the ring counter-clockwise, into each room on the way, and a little past the start.
std::vector<Pose> ring_path(const std::vector<Entrance>& entrances, double step) {
  std::vector<Pose> poses;
  double x = corridor / 2, y = corridor / 2, heading = 0;
  const auto stop = [&](double to_x, double to_y, double degrees_of_heading) {
    x = to_x;
    y = to_y;
    heading = degrees_of_heading;
    poses.push_back(pose_from_xyz_ypr({x, y, 0.6}, radians(heading), 0, 0));
  };
  const auto drive = [&](double to_x, double to_y, double along) {
    const double way = std::hypot(to_x - x, to_y - y);
    const int steps = std::max(1, static_cast<int>(std::ceil(way / step)));
    const double from_x = x, from_y = y;
    for (int k = 1; k <= steps; ++k)
      stop(from_x + (to_x - from_x) * k / steps, from_y + (to_y - from_y) * k / steps, along);
  };
  const auto visit = [&](const Entrance& door, double along) {
    const double lane = door.outwards < 0 ? corridor / 2 : width - corridor / 2;
    const double side = (along == 0 ? 1 : -1) * door.outwards;
    drive(door.x - (along == 0 ? 0.8 : -0.8), lane, along);
    stop(door.x, door.y, along + 25 * side);
    stop(door.x + (along == 0 ? 0.6 : -0.6), door.y + door.outwards * 1.6, along);
    stop(door.x, door.y, along - 10 * side);
    stop(door.x + (along == 0 ? 0.8 : -0.8), lane, along);
  };
  const auto turn_left = [&] {
    for (int k = 0; k < 3; ++k) stop(x, y, heading + 30);
  };
  stop(x, y, 0);
  for (int k = 0; k < 4; ++k) visit(entrances[static_cast<std::size_t>(k)], 0);
  drive(length - corridor / 2, corridor / 2, 0);
  turn_left();
  drive(length - corridor / 2, width - corridor / 2, 90);
  turn_left();
  for (int k = 7; k >= 4; --k) visit(entrances[static_cast<std::size_t>(k)], 180);
  drive(corridor / 2, width - corridor / 2, 180);
  turn_left();
  drive(corridor / 2, corridor / 2, 270);
  turn_left();
  drive(8, corridor / 2, 360);
  return poses;
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

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const double drift = argc > 2 ? std::strtod(argv[2], nullptr) : 1;
  std::vector<Entrance> entrances;
  const Building building = built(ring_plan(entrances));
  const double step = argc > 3 ? std::strtod(argv[3], nullptr) : 2.2;
  const std::vector<Pose> truth = ring_path(entrances, step);
  const auto simulated = simulate_scans(building.mesh.mesh, truth, {.seed = seed});
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
  const GraphResult result = relax_lu_milios(graph, scans);
  const Time relaxed = now();
  print_error("relaxed", result.graph.poses, truth);

  std::size_t unmatched = 0, accepted = 0, wrong = 0;
  for (const SequenceStep& way : sequence.steps) unmatched += !way.matched;
  for (const Edge& loop : loops) {
    if (!loop.accepted) continue;
    ++accepted;
    const Pose error = (truth[loop.from].inverse() * truth[loop.to]).inverse() * loop.from_from_to;
    wrong += error.translation().norm() > 0.1 || rotation_angle(error) > radians(1);
  }
  fmt::print("{} steps not matched; {} loops accepted, {} of them wrong, {} rejected\n", unmatched,
             accepted, wrong, loops.size() - accepted);
  print_time("made ready", start, made_ready);
  print_time("matched", made_ready, matched);
  print_time("loops", matched, closed);
  print_time("relaxed", closed, relaxed);
  print_time("all", start, relaxed);
}
