// From the registered cloud of the classroom (true poses) to labelled polygons, by steps: medians
// of several runs, then sizes, peak memory, and for 1, 2, 4 ... copies of the room how time grows
// with points. Usage: meshing_benchmark [COPIES]
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <sys/resource.h>
#include <vector>

#include <fmt/format.h>

#include "labeling/labels.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/free_space.hpp"
#include "meshing/laser_shadows.hpp"
#include "meshing/normals.hpp"
#include "meshing/polygons.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/slices.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace {

using namespace planum;

/// A registered cloud and where its scans were taken.
struct Registered {
  Cloud cloud;
  std::vector<Eigen::Vector3d> origins;
};

Registered classroom() {
  const auto folder =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/classroom";
  const std::vector<Pose> poses = read_pose_list(folder / "true_poses.txt");
  std::vector<Scan> scans;
  Registered result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    // As in a run, the world is the frame of the first scan.
    const Pose world_from_scan = poses.front().inverse() * poses[i];
    const RawScan raw = read_slices(folder / fmt::format("scan{:03}.slices", i));
    scans.push_back({.id = fmt::format("scan{:03}", i),
                     .number = static_cast<int>(i),
                     .world_from_scan = world_from_scan,
                     .cloud = points_from_slices(raw).cloud});
    result.origins.push_back(world_from_scan.translation());
  }
  result.cloud = merged(scans);
  return result;
}

/// Copies of a cloud side by side.
Registered copied(const Registered& one, int copies) {
  Registered all;
  for (int k = 0; k < copies; ++k) {
    const Eigen::Vector3d shift(20.0 * (k % 8), 20.0 * (k / 8), 0);
    const auto first = static_cast<std::uint32_t>(all.origins.size());
    for (const Eigen::Vector3d& origin : one.origins) all.origins.push_back(origin + shift);
    for (std::size_t i = 0; i < one.cloud.points.size(); ++i) {
      all.cloud.points.push_back(one.cloud.points[i] + shift.cast<float>());
      all.cloud.scan.push_back(first + one.cloud.scan[i]);
    }
  }
  return all;
}

double median_seconds(int runs, const std::function<void()>& body) {
  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    body();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

void measure(Registered& data, int runs) {
  const double voxel = SurfaceParams{}.voxel;
  TriangleMesh mesh;
  Regions planes;
  PolygonMap map;
  TriangulatedMap triangles;
  RoomMap rooms;
  const std::vector<std::function<void()>> steps = {
      [&] { data.cloud.normals = estimate_normals(data.cloud, data.origins); },
      [&] { in_free_space(data.cloud, data.origins); },
      [&] { mesh = reconstruct(data.cloud); },
      [&] { planes = grow_planes(mesh, data.cloud, region_params(voxel)); },
      [&] { map = polygonize(mesh, planes, polygon_params(voxel)); },
      [&] { map = with_shadows_filled(std::move(map), data.cloud, data.origins); },
      [&] { triangles = triangulated(map); },
      [&] { label(map); },
      [&] { rooms = find_rooms(data.cloud, data.origins, map); }};
  fmt::print("{:>10}", data.cloud.points.size());
  double all = 0;
  for (const auto& step : steps) {
    const double seconds = median_seconds(runs, step);
    all += seconds;
    fmt::print(" {:>9.3f}", seconds);
  }
  fmt::print(" {:>9.3f} {:>9} {:>9} {:>9} {:>6} {:>8.0f}\n", all, mesh.triangles.size(),
             map.polygons.size(), triangles.mesh.triangles.size(), rooms.rooms.size(),
             peak_megabytes());
}

}  // namespace

int main(int argc, char** argv) {
  const int most_copies = argc > 1 ? std::atoi(argv[1]) : 1;
  Registered data = classroom();
  fmt::print("seconds on {} threads; peak memory holds the raw scans and the cloud too\n",
             thread_count());
  fmt::print("{:>10}", "points");
  for (const char* step : {"normals", "free", "mesh", "planes", "polygons", "shadows", "triangles",
                           "labels", "rooms", "all"})
    fmt::print(" {:>9}", step);
  fmt::print(" {:>9} {:>9} {:>9} {:>6} {:>8}\n", "mesh", "polygons", "triangles", "rooms",
             "peak MB");
  measure(data, 5);
  for (int copies = 2; copies <= most_copies; copies *= 2) {
    Registered many = copied(data, copies);
    measure(many, 1);
  }
}
