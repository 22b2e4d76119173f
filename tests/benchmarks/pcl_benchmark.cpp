// One pair of kurt3d_corridor (scan 1 against scan 0, guess 26 cm off along the corridor), all
// counted from the clouds on: planum beside the ICP of PCL, point to plane and GICP, on points
// thinned to 5 cm. Built where PCL is installed.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>
#include <vector>

#include <fmt/format.h>

#include "slam/core/parallel.hpp"
#include "slam/io/uos.hpp"
#include "slam/registration/icp.hpp"
#include "slam/sensor/range_limits.hpp"

namespace {

using namespace planum;

constexpr int runs = 7;
constexpr float voxel = 0.05f;
constexpr double first_gate = 1.0;

using PointCloud = pcl::PointCloud<pcl::PointXYZ>;
using NormalCloud = pcl::PointCloud<pcl::PointNormal>;

PointCloud::Ptr thinned(const Cloud& cloud) {
  PointCloud::Ptr all(new PointCloud), result(new PointCloud);
  for (const Eigen::Vector3f& p : cloud.points) all->push_back({p.x(), p.y(), p.z()});
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(all);
  grid.setLeafSize(voxel, voxel, voxel);
  grid.filter(*result);
  return result;
}

NormalCloud::Ptr with_normals(const PointCloud::Ptr& points) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::PointNormal> estimation(
      static_cast<unsigned>(thread_count()));
  estimation.setInputCloud(points);
  estimation.setKSearch(12);
  NormalCloud::Ptr result(new NormalCloud);
  estimation.compute(*result);
  for (std::size_t i = 0; i < points->size(); ++i) {
    (*result)[i].x = (*points)[i].x;
    (*result)[i].y = (*points)[i].y;
    (*result)[i].z = (*points)[i].z;
  }
  return result;
}

template <class Registration, class CloudPtr>
Pose aligned(Registration& registration, const CloudPtr& source, const CloudPtr& target,
             const Pose& guess) {
  registration.setInputSource(source);
  registration.setInputTarget(target);
  registration.setMaxCorrespondenceDistance(first_gate);
  registration.setMaximumIterations(60);
  std::remove_cvref_t<decltype(*source)> moved;
  registration.align(moved, guess.matrix().cast<float>());
  Pose result;
  result.matrix() = registration.getFinalTransformation().template cast<double>();
  return result;
}

using Match = std::function<Pose(const Cloud& source, const Cloud& target, const Pose& guess)>;

Pose by_planum(const Cloud& source, const Cloud& target, const Pose& guess) {
  return align(matching_scan(source), matching_scan(target), guess, {.first_gate = first_gate})
      .target_from_source;
}

Pose by_pcl_planes(const Cloud& source, const Cloud& target, const Pose& guess) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  return aligned(icp, with_normals(thinned(source)), with_normals(thinned(target)), guess);
}

Pose by_pcl_gicp(const Cloud& source, const Cloud& target, const Pose& guess) {
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
  return aligned(gicp, thinned(source), thinned(target), guess);
}

void print(const char* name, const Match& match, const Cloud& source, const Cloud& target,
           const Pose& truth) {
  Pose guess = truth;
  guess.translation() += Eigen::Vector3d(0.26, 0, 0);  // along the corridor
  std::vector<double> times;
  Pose found;
  for (int run = 0; run < runs; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    found = match(source, target, guess);
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  fmt::print("{:22} {:7.1f} ms, {:5.1f} mm, {:.3f} deg\n", name, 1000 * times[runs / 2],
             1000 * (found.translation() - truth.translation()).norm(),
             degrees(rotation_angle(found, truth)));
}

}  // namespace

int main() {
  const auto folder =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared/datasets/kurt3d_corridor";
  const Cloud target = limited(read_uos_scan(folder / "scan000.3d")).cloud,
              source = limited(read_uos_scan(folder / "scan001.3d")).cloud;
  // Of scan 1 in the frame of scan 0, from the README of the data.
  const Pose truth = pose_from_uos({-3.809, -5.898, 156.411}, {1.308, -0.828, -0.516});
  print("planum", by_planum, source, target, truth);
  print("PCL, point to plane", by_pcl_planes, source, target, truth);
  print("PCL, GICP", by_pcl_gicp, source, target, truth);
}
