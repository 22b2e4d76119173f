#include "meshing/surfels.hpp"

#include <algorithm>
#include <cmath>

namespace planum {
namespace {

constexpr double min_agreement = 0.87;  // cosine, 30 degrees

}  // namespace

Surfels::Surfels(const Cloud& cloud, std::span<const std::uint32_t> points, double cube)
    : cube_(cube) {
  if (!points.empty()) origin_ = cloud.points[points.front()].cast<double>();
  of_point_.assign(points.size(), none);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t i = points[k];
    const Eigen::Vector3d normal = cloud.normals[i].cast<double>();
    if (normal.isZero()) continue;
    const Eigen::Vector3d p = cloud.points[i].cast<double>() - origin_;
    const std::array<std::int32_t, 3> place = cube_of(p + origin_);
    std::vector<std::uint32_t>& here = of_cube_[key(place)];
    std::uint32_t found = static_cast<std::uint32_t>(surfels_.size());
    for (const std::uint32_t s : here)
      if (surfels_[s].normals.dot(normal) > min_agreement * surfels_[s].normals.norm()) found = s;
    if (found == surfels_.size()) {
      here.push_back(found);
      surfels_.push_back({place, {}, Eigen::Vector3d::Zero()});
    }
    surfels_[found].moments.add(p);
    surfels_[found].normals += normal;
    of_point_[k] = found;
  }
}

std::array<std::int32_t, 3> Surfels::cube_of(const Eigen::Vector3d& point) const {
  std::array<std::int32_t, 3> cube;
  for (int k = 0; k < 3; ++k)
    cube[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(
        std::clamp(std::floor((point[k] - origin_[k]) / cube_), -1e6, 1e6));
  return cube;
}

std::uint64_t Surfels::key(const std::array<std::int32_t, 3>& cube) {
  std::uint64_t packed = 0;
  for (const std::int32_t c : cube)
    packed = packed << 21 | (static_cast<std::uint64_t>(c + (1 << 20)) & 0x1FFFFF);
  return packed;
}

}  // namespace planum
