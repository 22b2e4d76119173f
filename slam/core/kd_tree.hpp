#pragma once

#include <array>
#include <bit>
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
  friend bool operator<(const Neighbour& a, const Neighbour& b) { return a.rank() < b.rank(); }

  /// The same order as a number: floats that are not negative are ordered as their bits are.
  std::uint64_t rank() const {
    return std::uint64_t{std::bit_cast<std::uint32_t>(squared_distance)} << 32 | index;
  }
  static Neighbour of_rank(std::uint64_t rank) {
    return {static_cast<std::uint32_t>(rank),
            std::bit_cast<float>(static_cast<std::uint32_t>(rank >> 32))};
  }
};

/// What a search remembers for the next one of a query that moves little. For one tree only.
struct SearchMemory {
  std::uint32_t place = 0;  ///< leaf and place in its bucket where the last search ended; 0: none
  bool found = false;       ///< whether the point there was the answer
  Eigen::Vector3f query = {};  ///< m, of the last search that looked at the tree
  float others = -1;           ///< m, all other points are at least this far from that query
};

/// An exact nearest-neighbour search tree over 3D points (float): a complete binary tree in heap
/// order (children of node i: 2i and 2i+1, side by side in memory) over buckets of up to 16 points
/// that are padded to 16, with tight boxes. Immutable after construction, so that any number of
/// threads may search it. Distances above 1e19 m count as infinite: such points are never found.
class KdTree {
 public:
  /// Throws Error if a point is not finite.
  explicit KdTree(std::span<const Eigen::Vector3f> points);

  std::size_t size() const { return size_; }

  /// Numbers the points anew in the order of the leaves, so that points near each other in the list
  /// are near each other in space. Returns the old number of each; the list is to be sorted so.
  std::vector<std::uint32_t> number_by_leaf();

  /// The nearest point not farther than max_distance (m).
  std::optional<Neighbour> nearest(const Eigen::Vector3f& query, float max_distance) const;

  /// The same answer, faster for a query that moves little between searches. Where the triangle
  /// inequality shows that the last answer still is the nearest, the tree is not looked at
  /// (Greenspan & Godin, 3DIM 2001); else the search starts in the leaf where the last one ended
  /// and climbs only as far as it must (Nuechter, Lingemann, Hertzberg: Cached k-d tree search for
  /// ICP, 3DIM 2007).
  std::optional<Neighbour> nearest(const Eigen::Vector3f& query, float max_distance,
                                   SearchMemory& memory) const;

  /// The k nearest points within max_distance, ascending, written to `result` (its room is reused).
  void k_nearest(const Eigen::Vector3f& query, std::size_t k, std::vector<Neighbour>& result,
                 float max_distance = std::numeric_limits<float>::infinity()) const;

  /// All points within radius (m), ascending, written to `result` (its room is reused).
  void within(const Eigen::Vector3f& query, float radius, std::vector<Neighbour>& result) const;

 private:
  static constexpr std::size_t bucket_size = 16;

  struct alignas(32) Box {
    std::array<float, 4> low, high;  ///< x y z and a zero, four at a time for the processor
  };
  struct alignas(64) Bucket {
    std::array<float, bucket_size> x, y, z;        ///< beyond the last point: infinity
    std::array<std::uint32_t, bucket_size> index;  ///< where a point was in the input
  };
  friend class KdSearch;
  friend class KdBuild;

  std::size_t size_ = 0;
  std::uint32_t first_leaf_ = 1;  ///< leaves are the nodes [first_leaf_, 2 first_leaf_)
  std::vector<Box> boxes_;        ///< tight boxes of the nodes, from 1
  std::vector<Box> cells_;        ///< the parts of space the nodes answer for
  std::vector<Bucket> buckets_;   ///< the points of the leaves
};

}  // namespace planum
