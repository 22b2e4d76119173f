#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// The point of a surface that is nearest to another.
struct SurfacePoint {
  Eigen::Vector3d point;
  double distance = 0;         ///< m
  std::uint32_t triangle = 0;  ///< index in the mesh; the lowest of several at the same distance
};

/// Exact nearest points on a triangle mesh: a tree of boxes over its triangles. Immutable after
/// construction, so that any number of threads may search it.
class SurfaceTree {
 public:
  /// Throws Error if there is no triangle, one names a vertex that is not there, or a vertex is not
  /// finite.
  explicit SurfaceTree(const TriangleMesh& mesh);

  /// Empty if the surface is farther than max_distance (m).
  std::optional<SurfacePoint> nearest(
      const Eigen::Vector3d& query,
      double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Unit, out of the counter-clockwise side; zero for a triangle without area.
  Eigen::Vector3d normal(std::uint32_t triangle) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0, count = 0;  ///< of order_; count 0: children at first and first + 1
  };
  struct Item {
    Eigen::Vector3d centre;
    Eigen::AlignedBox3d box;
  };
  void build(std::size_t node, std::uint32_t begin, std::uint32_t end,
             const std::vector<Item>& items);

  TriangleMesh mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  ///< triangles, those of a leaf side by side
};

}  // namespace planum
