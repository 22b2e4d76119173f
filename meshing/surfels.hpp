#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/plane.hpp"

namespace planum {

/// The points of a cube of space whose normals agree.
struct Surfel {
  std::array<std::int32_t, 3> cube{};
  PointMoments moments;                               ///< relative to Surfels::origin
  Eigen::Vector3d normals = Eigen::Vector3d::Zero();  ///< sum
  Eigen::Vector3d normal() const { return normals.normalized(); }
};

/// Points with normals put together into surfels. A cube that several surfaces pass through has one
/// for each.
class Surfels {
 public:
  /// Of the points with these indices; those without a normal are left out.
  Surfels(const Cloud& cloud, std::span<const std::uint32_t> points, double cube);

  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  const std::vector<Surfel>& all() const { return surfels_; }
  /// For each point given, its surfel or none.
  const std::vector<std::uint32_t>& of_point() const { return of_point_; }
  const Eigen::Vector3d& origin() const { return origin_; }

  std::array<std::int32_t, 3> cube_of(const Eigen::Vector3d& point) const;

  /// Calls visit(index) for the surfels in a cube and the 26 around it, in a fixed order.
  template <typename Visit>
  void around(const std::array<std::int32_t, 3>& cube, Visit&& visit) const {
    for (std::int32_t z = -1; z <= 1; ++z)
      for (std::int32_t y = -1; y <= 1; ++y)
        for (std::int32_t x = -1; x <= 1; ++x) {
          const auto at = of_cube_.find(key({cube[0] + x, cube[1] + y, cube[2] + z}));
          if (at == of_cube_.end()) continue;
          for (const std::uint32_t s : at->second) visit(s);
        }
  }

 private:
  static std::uint64_t key(const std::array<std::int32_t, 3>& cube);

  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double cube_;
  std::vector<Surfel> surfels_;
  std::vector<std::uint32_t> of_point_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> of_cube_;
};

}  // namespace planum
