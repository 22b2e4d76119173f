// kurt3d_corridor: how long one pair takes with all that goes before; from how far a match finds
// its way; and from starts that are 25 cm and 5 degrees off in random directions, how far the poses
// end from the reference of the data's README.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "slam/graph/pose_graph.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "slam/io/uos.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tests/slam/registration/simulated_room.hpp"

namespace {

using namespace planum;
using testing::random_motion;

/// Shifts, turns and times of many starts.
struct Figures {
  std::vector<double> shifts, turns, seconds;

  void print(const char* what) {
    for (auto* values : {&shifts, &turns, &seconds}) std::sort(values->begin(), values->end());
    fmt::print(
        "{:28} median {:5.1f} mm {:5.3f} deg, worst {:5.1f} mm {:5.3f} deg, {:6.1f} ms ({} runs)\n",
        what, 1000 * shifts[shifts.size() / 2], turns[turns.size() / 2], 1000 * shifts.back(),
        turns.back(), 1000 * seconds[seconds.size() / 2], shifts.size());
  }

  void add(const Pose& found, const Pose& truth, double time) {
    shifts.push_back((found.translation() - truth.translation()).norm());
    turns.push_back(degrees(rotation_angle(found, truth)));
    seconds.push_back(time);
  }
};

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// One pair from the clouds on, nothing made ready before.
void print_whole_pair(const Cloud& target, const Cloud& source, const Pose& truth) {
  Figures figures;
  Pose guess = truth;
  guess.translation() += Eigen::Vector3d(0.26, 0, 0);  // along the corridor
  for (int run = 0; run < 15; ++run) {
    const double begin = now();
    const MatchingScan to = matching_scan(limited(target).cloud);
    const MatchingScan from = matching_scan(limited(source).cloud);
    figures.add(align(from, to, guess).target_from_source, truth, now() - begin);
  }
  figures.print("pair, all counted");
}

/// How many of 20 starts end within 5 cm and 1 degree of the truth.
void print_basin(const std::vector<MatchingScan>& scans, const Pose& truth, double shift,
                 double turn_degrees) {
  std::mt19937 random(7);
  int found = 0;
  Figures figures;
  for (int start = 0; start < 20; ++start) {
    const Pose guess = truth * random_motion(random, shift, radians(turn_degrees));
    const double begin = now();
    const Alignment alignment = align(scans[1], scans[0], guess, {.first_gate = 2.5});
    const Pose& pose = alignment.target_from_source;
    figures.add(pose, truth, now() - begin);
    found += (pose.translation() - truth.translation()).norm() < 0.05 &&
             rotation_angle(pose, truth) < radians(1);
  }
  fmt::print("from {:.1f} m and {:.0f} deg: {} of 20\n", shift, turn_degrees, found);
  figures.print("  these");
}

}  // namespace

int main() {
  const auto folder =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/kurt3d_corridor";
  std::vector<MatchingScan> scans;
  std::vector<Cloud> clouds;
  std::vector<Pose> given;
  for (const std::string name : {"scan000", "scan001", "scan002"}) {
    clouds.push_back(read_uos_scan(folder / (name + ".3d")));
    scans.push_back(matching_scan(limited(clouds.back()).cloud));
    given.push_back(read_uos_pose(folder / (name + ".pose")));
  }
  const std::vector<Pose> reference = {
      Pose::Identity(), pose_from_uos({-3.809, -5.898, 156.411}, {1.308, -0.828, -0.516}),
      pose_from_uos({-8.262, -13.725, 339.371}, {0.367, -0.488, -0.309})};
  print_whole_pair(clouds[0], clouds[1], reference[1]);
  print_basin(scans, reference[1], 1.0, 15);
  print_basin(scans, reference[1], 2.0, 30);
  std::mt19937 random(1);
  Figures pairs[2], graphs[2];
  for (int start = 0; start < 50; ++start) {
    std::vector<Pose> odometry = given;
    for (std::size_t i = 1; i < odometry.size(); ++i)
      odometry[i] = odometry[i - 1] * given[i - 1].inverse() * given[i] *
                    random_motion(random, 0.25, radians(5));
    for (std::size_t i = 0; i < 2; ++i) {
      const double begin = now();
      const Alignment found =
          align(scans[i + 1], scans[i], odometry[i].inverse() * odometry[i + 1]);
      pairs[i].add(found.target_from_source, reference[i].inverse() * reference[i + 1],
                   now() - begin);
    }
    const double begin = now();
    const PoseGraph graph = pose_graph(match_in_order(odometry, icp_matcher(scans)));
    const std::vector<Pose> poses = relax_lu_milios(graph, scans).graph.poses;
    const double time = now() - begin;
    for (std::size_t i = 0; i < 2; ++i)
      graphs[i].add(poses[i].inverse() * poses[i + 1], reference[i].inverse() * reference[i + 1],
                    time);
  }
  pairs[0].print("scan 1 against 0");
  pairs[1].print("scan 2 against 1");
  graphs[0].print("all relaxed, 0 to 1");
  graphs[1].print("all relaxed, 1 to 2");
}
