#include "slam/core/cloud.hpp"

#include <algorithm>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 1 << 14;

/// Writes the transformed points and normals of `from` to `to` at `offset`; `to` is large enough.
void transform_into(const Cloud& from, const Pose& b_from_a, std::size_t offset, Cloud& to) {
  const Eigen::Matrix3d rotation = b_from_a.linear();
  const Eigen::Matrix3f rotation_f = rotation.cast<float>();
  const Eigen::Vector3d translation = b_from_a.translation();
  const bool with_normals = !to.normals.empty();
  parallel_for(from.points.size(), points_per_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      to.points[offset + i] =
          (rotation * from.points[i].cast<double>() + translation).cast<float>();
      if (with_normals) to.normals[offset + i] = rotation_f * from.normals[i];
    }
  });
}

}  // namespace

Cloud transformed(const Cloud& cloud, const Pose& b_from_a) {
  Cloud result = cloud;
  transform_into(cloud, b_from_a, 0, result);
  return result;
}

Cloud merged(const std::vector<Scan>& scans) {
  std::size_t count = 0;
  bool with_normals = true, with_intensity = true;
  for (const Scan& scan : scans) {
    const std::size_t n = scan.cloud.points.size();
    count += n;
    with_normals = with_normals && scan.cloud.normals.size() == n;
    with_intensity = with_intensity && scan.cloud.intensity.size() == n;
  }
  Cloud result;
  result.points.resize(count);
  result.scan.resize(count);
  if (with_normals) result.normals.resize(count);
  if (with_intensity) result.intensity.resize(count);
  std::size_t offset = 0;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const Cloud& cloud = scans[s].cloud;
    transform_into(cloud, scans[s].world_from_scan, offset, result);
    if (with_intensity)
      std::copy(cloud.intensity.begin(), cloud.intensity.end(),
                result.intensity.begin() + static_cast<std::ptrdiff_t>(offset));
    std::fill_n(result.scan.begin() + static_cast<std::ptrdiff_t>(offset), cloud.points.size(),
                static_cast<std::uint32_t>(s));
    offset += cloud.points.size();
  }
  return result;
}

}  // namespace planum
