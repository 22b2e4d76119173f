#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/sensor/building.hpp"
#include "slam/sensor/ray_caster.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum::testing {

/// A furnished room whose plan is an L, turned out of the axes.
inline Building furnished_room() {
  BuildingPlan plan;
  plan.name = "room";
  plan.rooms = {{.name = "room",
                 .walls = {.outer = {{0, 0}, {6, 0}, {6, 3}, {4, 3}, {4, 5}, {0, 5}}},
                 .height = 2.6}};
  plan.furniture = {{.base = {2.5, 2.2, 0}, .size = {1.2, 0.7, 0.75}, .turn = 0.4},
                    {.base = {5.4, 0.5, 0}, .size = {0.8, 0.6, 1.9}, .turn = 0},
                    {.base = {0.5, 4.2, 0}, .size = {0.5, 1.0, 1.2}, .turn = 0.1}};
  plan.turn = 0.3;
  return built(plan);
}

/// A corridor without any feature along it.
inline Building bare_corridor() {
  BuildingPlan plan;
  plan.name = "corridor";
  plan.rooms = {{.name = "corridor",
                 .walls = {.outer = {{-60, -1}, {60, -1}, {60, 1}, {-60, 1}}},
                 .height = 2.4}};
  return built(plan);
}

/// A light scan of a model from somewhere; `number` tells the noise of scans apart.
inline Cloud scan_of(const Building& building, const Pose& building_from_scan,
                     std::uint64_t number = 0, double noise = 0.005) {
  const RayCaster model(building.mesh.mesh);
  SimulatorParams params;
  params.laser.max_range = 12;
  params.beams = 181;
  params.slices = 90;
  params.range_noise = noise;
  params.mixed_pixel = 0;
  return points_from_slices(simulate_scan(model, building_from_scan, number, params).scan).cloud;
}

/// Stops in a room and a scan of each.
struct Walk {
  std::vector<Pose> truth;
  std::vector<MatchingScan> scans;
};

/// Scans of the furnished room from some poses; `draw` makes other noise.
inline Walk walk_in_room(std::vector<Pose> truth, std::uint64_t draw = 0, double noise = 0.005) {
  const Building room = furnished_room();
  Walk walk{std::move(truth), {}};
  for (std::size_t i = 0; i < walk.truth.size(); ++i)
    walk.scans.push_back(matching_scan(scan_of(room, walk.truth[i], 10 * draw + i, noise)));
  return walk;
}

/// A motion of a given length and angle in random directions.
inline Pose random_motion(std::mt19937& random, double shift, double angle) {
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, direction()).toRotationMatrix();
  pose.translation() = shift * direction();
  return pose;
}

inline double shift_between(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

/// Runs with so many threads, then with as many as before.
class ThreadCount {
 public:
  explicit ThreadCount(int threads) : before_(thread_count()) { set_thread_count(threads); }
  ~ThreadCount() { set_thread_count(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

/// The message of the Error that a call throws; empty if it throws none.
template <typename Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace planum::testing
