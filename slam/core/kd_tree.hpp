#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// A point found by a KdTree: its position in the list the tree was built from.
struct Neighbour {
  std::uint32_t index = 0;
  float squared_distance = 0;  ///< m^2

  /// Nearer first, then the lower index: answers do not depend on the order of the search.
  friend bool operator<(const Neighbour& a, const Neighbour& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                    : a.index < b.index;
  }
};

/// An exact nearest-neighbour search tree over 3D points (float): a complete binary tree in heap
/// order (children of node i: 2i and 2i+1, side by side in memory) over buckets of up to 16 points,
/// with tight boxes. Immutable after construction, so that any number of threads may search it.
class KdTree {
 public:
  /// Throws Error if a point is not finite.
  explicit KdTree(std::span<const Eigen::Vector3f> points);

  std::size_t size() const { return indices_.size(); }

  /// The nearest point not farther than max_distance (m).
  std::optional<Neighbour> nearest(const Eigen::Vector3f& query, float max_distance) const;

  /// The same answer, faster for a query that moves little between searches: `leaf_hint` keeps the
  /// leaf where the last search ended (0 at first), and this one starts there and climbs only as
  /// far as it must (Nuechter, Lingemann, Hertzberg: Cached k-d tree search for ICP, 3DIM 2007).
  std::optional<Neighbour> nearest(const Eigen::Vector3f& query, float max_distance,
                                   std::uint32_t& leaf_hint) const;

  /// The k nearest points within max_distance, ascending, written to `result` (its room is reused).
  void k_nearest(const Eigen::Vector3f& query, std::size_t k, std::vector<Neighbour>& result,
                 float max_distance = std::numeric_limits<float>::infinity()) const;

  /// All points within radius (m), ascending, written to `result` (its room is reused).
  void within(const Eigen::Vector3f& query, float radius, std::vector<Neighbour>& result) const;

 private:
  struct Box {
    Eigen::Array3f low, high;
  };
  friend class KdSearch;

  std::uint32_t first_leaf_ = 1;           ///< leaves are the nodes [first_leaf_, 2 first_leaf_)
  std::vector<Box> boxes_;                 ///< tight boxes of the nodes, from 1
  std::vector<Box> cells_;                 ///< the parts of space the nodes answer for
  std::vector<std::uint32_t> leaf_begin_;  ///< first point of each leaf, and the end of the last
  std::vector<float> x_, y_, z_;           ///< points sorted by leaf, one array a coordinate
  std::vector<std::uint32_t> indices_;     ///< where a sorted point was in the input
};

}  // namespace planum
