#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "meshing/regions.hpp"

namespace planum {

/// Which regions of a mesh are near a point: a hash table of cubes that the regions pass through.
class RegionLookup {
 public:
  static constexpr std::size_t capacity = 4;               ///< regions remembered a cube
  using Candidates = std::array<std::uint32_t, capacity>;  ///< ends with Regions::rest where fewer

  /// Points up to `reach` (m) off a region, along its normal, are found.
  RegionLookup(const Regions& regions, const TriangleMesh& mesh, double reach);

  /// The regions near a point; null if none.
  const Candidates* near(const Eigen::Vector3f& point) const;

  /// m, the side of the cubes.
  double cube() const { return cube_; }

 private:
  struct Slot {
    std::uint64_t key = free_slot;
    Candidates candidates;
  };
  static constexpr std::uint64_t free_slot = ~std::uint64_t{0};

  std::uint64_t key(const Eigen::Vector3d& point) const;
  std::size_t slot_of(std::uint64_t key) const;
  void mark(const Eigen::Vector3d& point, std::uint32_t region);
  void grow();

  Eigen::Vector3d low_ = Eigen::Vector3d::Zero(), size_ = Eigen::Vector3d::Zero();
  double cube_ = 0;
  std::size_t used_ = 0;
  std::vector<Slot> slots_;
};

}  // namespace planum
