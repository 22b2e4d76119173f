#include "meshing/region_lookup.hpp"

#include <algorithm>
#include <cmath>

namespace planum {
namespace {

constexpr double max_cubes_a_side = (1 << 20) - 1;

}  // namespace

RegionLookup::RegionLookup(const Regions& regions, const TriangleMesh& mesh, double reach)
    : cube_(2 * reach), slots_(1024) {
  if (mesh.vertices.empty()) return;
  Eigen::Vector3f low = mesh.vertices.front(), high = low;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  low_ = low.cast<double>().array() - 2 * reach;
  size_ = (high - low).cast<double>().array() + 4 * reach;
  cube_ = std::max(cube_, size_.maxCoeff() / max_cubes_a_side);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const std::uint32_t region = regions.of_triangle[f];
    if (region == Regions::rest) continue;
    const auto& t = mesh.triangles[f];
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>() - a;
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>() - a;
    const Eigen::Vector3d off = reach * regions.regions[region].plane.normal;
    const double longest =
        std::sqrt(std::max({b.squaredNorm(), c.squaredNorm(), (b - c).squaredNorm()}));
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / cube_)), 1, 1000);
    // Centroids of the upright ones of parts^2 smaller triangles.
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        const Eigen::Vector3d p = a + (i + 1.0 / 3) / parts * b + (j + 1.0 / 3) / parts * c;
        for (const double side : {-1.0, 0.0, 1.0}) mark(p + side * off, region);
      }
  }
}

const RegionLookup::Candidates* RegionLookup::near(const Eigen::Vector3f& point) const {
  const Eigen::Vector3d p = point.cast<double>() - low_;
  if ((p.array() < 0).any() || (p.array() > size_.array()).any()) return nullptr;
  const Slot& slot = slots_[slot_of(key(point.cast<double>()))];
  return slot.key == free_slot ? nullptr : &slot.candidates;
}

std::uint64_t RegionLookup::key(const Eigen::Vector3d& point) const {
  std::uint64_t packed = 0;
  for (int k = 0; k < 3; ++k)
    packed = packed << 21 | static_cast<std::uint64_t>((point[k] - low_[k]) / cube_);
  return packed;
}

std::size_t RegionLookup::slot_of(std::uint64_t key) const {
  // Multiplicative hashing; the odd constant is 2^64 over the golden ratio.
  std::size_t at = (key * 0x9E3779B97F4A7C15u) >> 32 & (slots_.size() - 1);
  while (slots_[at].key != key && slots_[at].key != free_slot) at = (at + 1) & (slots_.size() - 1);
  return at;
}

void RegionLookup::mark(const Eigen::Vector3d& point, std::uint32_t region) {
  Slot& slot = slots_[slot_of(key(point))];
  if (slot.key == free_slot) {
    slot.key = key(point);
    slot.candidates.fill(Regions::rest);
    slot.candidates[0] = region;
    if (2 * ++used_ > slots_.size()) grow();
    return;
  }
  for (std::uint32_t& candidate : slot.candidates) {
    if (candidate == region) return;
    if (candidate != Regions::rest) continue;
    candidate = region;
    return;
  }
}

void RegionLookup::grow() {
  std::vector<Slot> old(slots_.size() * 2);
  old.swap(slots_);
  for (const Slot& slot : old)
    if (slot.key != free_slot) slots_[slot_of(slot.key)] = slot;
}

}  // namespace planum
