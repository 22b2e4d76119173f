#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Where a ray meets a mesh first.
struct RayHit {
  double distance = 0;         ///< m
  std::uint32_t triangle = 0;  ///< index in the mesh
  Eigen::Vector3f normal;      ///< unit, of the triangle: out of its counter-clockwise side
};

/// Casts rays against a triangle mesh (Embree). Both sides of a triangle stop a ray. Any number of
/// threads may cast at once; the tree is built by one, so that answers are always the same.
class RayCaster {
 public:
  /// Throws Error if a triangle names a vertex that is not there, or a vertex is not finite.
  explicit RayCaster(const TriangleMesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The nearest hit up to max_distance (m); direction is unit.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_distance) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace planum
