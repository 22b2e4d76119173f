#include "slam/evaluation/sampling.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "slam/core/hash.hpp"
#include "slam/evaluation/mesh_corners.hpp"

namespace planum {
namespace {

/// In [0, 1), as good as random.
double hashed(std::uint64_t i) {
  return static_cast<double>(mixed(i + 0x9e3779b97f4a7c15) >> 11) * 0x1p-53;
}

}  // namespace

std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t wanted) {
  const std::size_t parts = wanted == 0 ? count : std::min(count, wanted);
  std::vector<std::size_t> chosen(parts);
  for (std::size_t k = 0; k < parts; ++k) {
    const std::size_t begin = count * k / parts, end = count * (k + 1) / parts;
    chosen[k] = begin + static_cast<std::size_t>(hashed(k) * static_cast<double>(end - begin));
  }
  return chosen;
}

Cloud chosen_points(const Cloud& cloud, const std::vector<std::size_t>& positions) {
  Cloud result;
  for (const std::size_t i : positions) {
    result.points.push_back(cloud.points[i]);
    if (!cloud.normals.empty()) result.normals.push_back(cloud.normals[i]);
    if (!cloud.intensity.empty()) result.intensity.push_back(cloud.intensity[i]);
    if (!cloud.scan.empty()) result.scan.push_back(cloud.scan[i]);
  }
  return result;
}

SurfaceSamples surface_samples(const TriangleMesh& mesh, std::size_t count) {
  check_mesh(mesh);
  std::vector<double> area_up_to;
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners c = corners_of(mesh, t);
    area_up_to.push_back(area += (c[1] - c[0]).cross(c[2] - c[0]).norm() / 2);
  }
  SurfaceSamples samples;
  if (!(area > 0)) return samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = (static_cast<double>(k) + hashed(3 * k)) / static_cast<double>(count) * area;
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, at);
    const auto t = static_cast<std::uint32_t>(found - area_up_to.begin());
    double u = hashed(3 * k + 1), v = hashed(3 * k + 2);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Corners c = corners_of(mesh, t);
    samples.points.push_back(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]));
    samples.triangles.push_back(t);
  }
  return samples;
}

}  // namespace planum
