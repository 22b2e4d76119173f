// From the registered cloud of the classroom (true poses) to the mesh, by steps: medians of several
// runs, then sizes, peak memory, and for 1, 2, 4 ... copies of the room how time grows with points.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <sys/resource.h>
#include <vector>

#include <fmt/format.h>

#include "meshing/distance_field.hpp"
#include "meshing/marching_cubes.hpp"
#include "meshing/normals.hpp"
#include "meshing/up_direction.hpp"
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
  DistanceField field;
  TriangleMesh mesh;
  const double normals = median_seconds(
      runs, [&] { data.cloud.normals = estimate_normals(data.cloud, data.origins); });
  const double up =
      median_seconds(runs, [&] { estimate_up(data.cloud.normals, {}, Eigen::Vector3d::UnitZ()); });
  const double distance = median_seconds(runs, [&] { field = distance_field(data.cloud); });
  const double cubes = median_seconds(runs, [&] { mesh = marching_cubes(field); });
  fmt::print("{:>10} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>10} {:>10} {:>8.0f}\n",
             data.cloud.points.size(), normals, up, distance, cubes,
             normals + up + distance + cubes, mesh.vertices.size(), mesh.triangles.size(),
             peak_megabytes());
}

}  // namespace

int main(int argc, char** argv) {
  const int most_copies = argc > 1 ? std::atoi(argv[1]) : 1;
  Registered data = classroom();
  fmt::print("seconds on {} threads; peak memory holds the raw scans and the cloud too\n",
             thread_count());
  fmt::print("{:>10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>10} {:>10} {:>8}\n", "points", "normals",
             "up", "distance", "cubes", "all", "vertices", "triangles", "peak MB");
  measure(data, 5);
  for (int copies = 2; copies <= most_copies; copies *= 2) {
    Registered many = copied(data, copies);
    measure(many, 1);
  }
}
