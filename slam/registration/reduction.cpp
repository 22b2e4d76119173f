#include "slam/registration/reduction.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr int bits_per_axis = 21;

/// Sums of the points of one voxel relative to its centre, then the point nearest their mean.
struct Voxel {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float count = 0;
  float squared_distance = std::numeric_limits<float>::infinity();
  std::uint32_t nearest = none;
};

/// An open-addressing table from voxel keys to consecutive numbers.
class KeyNumbers {
 public:
  explicit KeyNumbers(std::size_t most)
      : slots_(std::bit_ceil(2 * most + 2)), shift_(64 - std::countr_zero(slots_.size())) {}

  /// The number of a key; a new key gets the next one.
  std::uint32_t number(std::uint64_t key) {
    // Fibonacci hashing: the high bits of the product depend on all bits of the key.
    std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> shift_;
    while (slots_[slot].number != none && slots_[slot].key != key)
      slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot].number == none) slots_[slot] = {key, count_++};
    return slots_[slot].number;
  }
  std::uint32_t count() const { return count_; }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t number = none;
  };
  std::vector<Slot> slots_;
  int shift_;
  std::uint32_t count_ = 0;
};

struct VoxelIndex {
  Eigen::Vector3d cell;  ///< whole numbers

  std::uint64_t key() const {
    std::uint64_t result = 0;
    for (const double c : cell) {
      const auto shifted = static_cast<std::int64_t>(c) + (std::int64_t{1} << (bits_per_axis - 1));
      result = (result << bits_per_axis) | static_cast<std::uint64_t>(shifted);
    }
    return result;
  }
};

VoxelIndex voxel_of(const Eigen::Vector3f& point, double per_voxel) {
  return {(point.cast<double>() * per_voxel).array().floor()};
}

void check_reach(std::span<const Eigen::Vector3f> points, double voxel) {
  const double limit = voxel * (1 << (bits_per_axis - 1));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!((points[i].cwiseAbs().array() < static_cast<float>(limit)).all()))
      throw Error(
          fmt::format("scan reduction: point {} ({}, {}, {}) is not finite or farther than "
                      "{} m, the reach of a voxel of {} m",
                      i, points[i].x(), points[i].y(), points[i].z(), limit, voxel));
}

}  // namespace

VoxelGrid voxel_grid(std::span<const Eigen::Vector3f> points, double voxel) {
  if (!(voxel > 0) || !std::isfinite(voxel))
    throw Error(fmt::format("scan reduction: the voxel must be positive, got {} m", voxel));
  check_reach(points, voxel);
  const double per_voxel = 1 / voxel;
  KeyNumbers numbers(points.size());
  VoxelGrid result{.voxel_of_point = std::vector<std::uint32_t>(points.size()),
                   .representative = {}};
  std::vector<Voxel> voxels;
  voxels.reserve(points.size() / 4);
  const auto relative = [&](std::size_t i, const VoxelIndex& index) -> Eigen::Vector3f {
    return (points[i].cast<double>() - voxel * index.cell).cast<float>();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VoxelIndex index = voxel_of(points[i], per_voxel);
    result.voxel_of_point[i] = numbers.number(index.key());
    if (result.voxel_of_point[i] == voxels.size()) voxels.emplace_back();
    Voxel& v = voxels[result.voxel_of_point[i]];
    v.sum += relative(i, index);
    v.count += 1;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Voxel& v = voxels[result.voxel_of_point[i]];
    const Eigen::Vector3f p = relative(i, voxel_of(points[i], per_voxel));
    const float squared = (p - v.sum / v.count).squaredNorm();
    if (squared >= v.squared_distance) continue;
    v.squared_distance = squared;
    v.nearest = static_cast<std::uint32_t>(i);
  }
  result.representative.reserve(voxels.size());
  for (const Voxel& v : voxels) result.representative.push_back(v.nearest);
  return result;
}

Cloud reduced(const Cloud& cloud, double voxel) {
  if (voxel == 0) return cloud;
  const std::vector<std::uint32_t> kept = voxel_grid(cloud.points, voxel).representative;
  const auto selected = [&](const auto& values) {
    std::remove_cvref_t<decltype(values)> result;
    if (values.empty()) return result;
    result.reserve(kept.size());
    for (const std::uint32_t i : kept) result.push_back(values[i]);
    return result;
  };
  return {.points = selected(cloud.points),
          .normals = selected(cloud.normals),
          .intensity = selected(cloud.intensity),
          .scan = selected(cloud.scan)};
}

}  // namespace planum
