// Scans registered, with and without relaxation, then refined on the planes they share: error of
// the path where truth is known, thickness of walls, gap between what different scans see of one,
// and time.
//
// usage: refinement_benchmark SCENE [SEED [NOISE]]
//   SCENE: ring, demo, random (rooms along a corridor), classroom, corridor (real), apartment
//   (real) NOISE: m, of the ranges where they are simulated
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/plane.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/plane_refinement.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/tum.hpp"
#include "slam/io/uos.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/random_building.hpp"
#include "slam/sensor/range_limits.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/benchmarks/ring_building.hpp"
#include "tests/support/numbered.hpp"

namespace {

using namespace planum;

struct Scene {
  std::vector<Cloud> clouds;
  std::vector<Pose> odometry;
  std::vector<Pose> truth;  ///< empty: not known
};

Scene simulated(const Building& building, std::vector<Pose> truth, std::uint64_t seed, double noise,
                double bend) {
  Scene scene;
  for (SimulatedScan& scan :
       simulate_scans(building.mesh.mesh, truth, {.range_noise = noise, .seed = seed})) {
    for (Slice& slice : scan.scan.slices) slice.tilt *= 1 + bend;
    scene.clouds.push_back(points_from_slices(scan.scan).cloud);
  }
  scene.odometry = drifted(truth, {.translation_per_metre = 0.02,
                                   .heading_per_metre = 0.004,
                                   .heading_per_radian = 0.01,
                                   .heading_bias_per_metre = 0.0006,
                                   .seed = seed});
  scene.truth = std::move(truth);
  return scene;
}

std::filesystem::path shared(const std::string& name) {
  return std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared" / "datasets" / name;
}

Scene classroom() {
  Scene scene;
  for (int i = 0; i < 12; ++i)
    scene.clouds.push_back(
        points_from_slices(read_slices(shared("classroom") / fmt::format("scan{:03}.slices", i)))
            .cloud);
  for (const StampedPose& p : read_tum(shared("classroom") / "odometry.tum"))
    scene.odometry.push_back(p.pose);
  for (const StampedPose& p : read_tum(shared("classroom") / "truth.tum"))
    scene.truth.push_back(p.pose);
  return scene;
}

Scene corridor() {
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    const std::string name = fmt::format("scan{:03}", i);
    scene.clouds.push_back(
        limited(read_uos_scan(shared("kurt3d_corridor") / (name + ".3d"))).cloud);
    scene.odometry.push_back(read_uos_pose(shared("kurt3d_corridor") / (name + ".pose")));
  }
  return scene;
}

/// The points of a legacy VTK file in ASCII.
Cloud vtk_points(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string word;
  std::size_t count = 0;
  while (in >> word && word != "POINTS") continue;
  in >> count >> word;
  Cloud cloud;
  Eigen::Vector3f p;
  while (cloud.points.size() < count && in >> p.x() >> p.y() >> p.z()) cloud.points.push_back(p);
  if (cloud.points.size() < count) throw Error(path.string() + ": too few points");
  return cloud;
}

Scene apartment() {
  Scene scene;
  scene.clouds = {vtk_points(shared("eth_apartment") / "cloud_0.vtk"),
                  vtk_points(shared("eth_apartment") / "cloud_1.vtk")};
  scene.odometry = {Pose::Identity(),
                    pose_from_xyz_ypr({0.6139, -0.0132, 0.0056}, radians(6.65), 0, 0)};
  return scene;
}

Scene scene_of(const std::string& name, std::uint64_t seed, double noise, double bend) {
  if (name == "ring") {
    const testing::RingBuilding ring = testing::ring_building();
    return simulated(ring.building, ring.poses, seed, noise, bend);
  }
  if (name == "demo") return simulated(demo_building(), demo_poses(), seed, noise, bend);
  if (name == "random") {
    const RandomBuilding random = random_building(seed);
    return simulated(random.building, random.poses, seed, noise, bend);
  }
  if (name == "classroom") return classroom();
  if (name == "corridor") return corridor();
  if (name == "apartment") return apartment();
  throw Error("no such scene: " + name);
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr double cube_edge = 0.4;     // m
constexpr double least_of_scan = 10;  // points of a scan in a cube

/// What walls look like in cubes of the world: rms distance of points from the plane through all of
/// a cube that face alike, and how far the scans' own means lie apart along its normal.
struct Walls {
  double thickness = 0, gap = 0;  ///< m
  std::size_t cells = 0;
};

Walls walls(const std::vector<MatchingScan>& scans, const std::vector<Pose>& poses) {
  struct Point {
    std::size_t scan;
    Eigen::Vector3d place;
  };
  std::map<std::array<int, 4>, std::vector<Point>> cells;
  const Pose first_from_world = poses.front().inverse();
  for (std::size_t s = 0; s < scans.size(); ++s)
    for (std::size_t i = 0; i < scans[s].points.size(); ++i) {
      if (!scans[s].planes[i].known()) continue;
      const Pose pose = first_from_world * poses[s];
      const Eigen::Vector3d place = pose * scans[s].points[i].cast<double>();
      const Eigen::Vector3d normal = pose.linear() * scans[s].planes[i].normal.cast<double>();
      Eigen::Index axis = 0;
      if (normal.cwiseAbs().maxCoeff(&axis) < 0.9) continue;
      const Eigen::Vector3i cell = (place / cube_edge).array().floor().cast<int>();
      cells[{cell.x(), cell.y(), cell.z(), static_cast<int>(axis + (normal[axis] > 0 ? 3 : 0))}]
          .push_back({s, place});
    }
  Walls result;
  double squares = 0, count = 0;
  for (const auto& [key, points] : cells) {
    std::vector<Eigen::Vector3d> places;
    std::map<std::size_t, PointMoments> of_scan;
    for (const Point& p : points) places.push_back(p.place);
    const std::optional<PlaneFit> fit = fit_plane(places);
    if (!fit || fit->variances[0] > 0.03 * 0.03 || fit->variances[1] < 0.05 * 0.05) continue;
    for (const Point& p : points)
      of_scan[p.scan].add(Eigen::Vector3d(fit->plane.signed_distance(p.place), 0, 0));
    std::erase_if(of_scan, [](const auto& s) { return s.second.count < least_of_scan; });
    if (of_scan.size() < 2) continue;
    double low = 1, high = -1;
    for (const auto& [scan, moments] : of_scan) {
      low = std::min(low, moments.centroid().x());
      high = std::max(high, moments.centroid().x());
    }
    result.gap += high - low;
    squares += fit->variances[0] * static_cast<double>(points.size());
    count += static_cast<double>(points.size());
    ++result.cells;
  }
  result.gap /= static_cast<double>(std::max<std::size_t>(result.cells, 1));
  result.thickness = std::sqrt(squares / std::max(count, 1.0));
  return result;
}

void print(const std::string& what, const Scene& scene, const std::vector<MatchingScan>& scans,
           const std::vector<Pose>& poses) {
  const Walls w = walls(scans, poses);
  fmt::print("{:22}", what);
  if (!scene.truth.empty()) {
    const TrajectoryError error =
        trajectory_error(testing::numbered(poses), testing::numbered(scene.truth));
    fmt::print(" rmse {:7.3f} mm, most {:7.3f} mm, {:.4f} deg;", 1000 * error.ape_translation.rmse,
               1000 * error.ape_translation.max, error.ape_rotation.mean);
  }
  fmt::print(" thickness {:6.3f} mm, gap {:6.3f} mm\n", 1000 * w.thickness, 1000 * w.gap);
}

void refine(const std::string& what, const Scene& scene, const std::vector<MatchingScan>& scans,
            const std::vector<Pose>& poses) {
  print(what, scene, scans, poses);
  const double start = now();
  const PlaneRefinement r = refine_planes(poses, scans);
  const double seconds = now() - start;
  print("  refined", scene, scans, r.poses);
  fmt::print(
      "    held out {:.4f} -> {:.4f} mm, {} planes, {} observations, {} iterations{}, moved {:.2f} "
      "mm (most {:.2f}), {:.2f} s {}\n",
      1000 * r.thickness_before, 1000 * r.thickness_after, r.planes, r.observations, r.iterations,
      r.converged ? "" : " (not converged)", 1000 * r.moved_rms, 1000 * r.moved_most, seconds,
      r.reason);
}

int run(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "demo";
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const double noise = argc > 3 ? std::strtod(argv[3], nullptr) : 0.01;
  const double bend = argc > 4 ? std::strtod(argv[4], nullptr) : 0;
  const Scene scene = scene_of(name, seed, noise, bend);
  std::vector<std::optional<MatchingScan>> ready(scene.clouds.size());
  parallel_for(ready.size(), 1,
               [&](std::size_t i, std::size_t) { ready[i] = matching_scan(scene.clouds[i]); });
  std::vector<MatchingScan> scans;
  for (auto& scan : ready) scans.push_back(std::move(*scan));
  fmt::print("{} scans of {}, seed {}, noise {} m, bend {}\n", scans.size(), name, seed, noise,
             bend);

  const SequenceMatch sequence = match_in_order(scene.odometry, icp_matcher(scans));
  PoseGraph graph = pose_graph(sequence);
  const std::vector<Edge> loops = find_loops(scans, graph, icp_gated_matcher(scans));
  graph.edges.insert(graph.edges.end(), loops.begin(), loops.end());
  const double start = now();
  const std::vector<Pose> relaxed = relax_lu_milios(graph, scans).graph.poses;
  const double seconds = now() - start;
  if (!scene.truth.empty()) refine("true poses", scene, scans, scene.truth);
  refine("matched in order", scene, scans, sequence.poses);
  refine("loops closed", scene, scans, relax_edges(graph).poses);
  refine("relaxed", scene, scans, relaxed);
  fmt::print("relaxation alone {:.2f} s\n", seconds);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const Error& error) {
    fmt::print("{}\n", error.what());
    return 1;
  }
}
