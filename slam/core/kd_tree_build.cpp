#include <algorithm>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
/// The number in the places of a bucket that are empty.
constexpr std::uint32_t no_point = std::numeric_limits<std::uint32_t>::max();

struct IndexedPoint {
  std::array<float, 3> point;
  std::uint32_t index;
};

std::vector<IndexedPoint> indexed(std::span<const Eigen::Vector3f> points) {
  std::vector<IndexedPoint> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f& p = points[i];
    if (!p.allFinite())
      throw Error(
          fmt::format("search tree: point {} is not finite ({}, {}, {})", i, p.x(), p.y(), p.z()));
    result[i] = {{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(i)};
  }
  return result;
}

/// Leaves of a complete tree in which no leaf holds more than a bucket.
std::uint32_t leaf_count(std::size_t points, std::size_t bucket_size) {
  const std::size_t buckets = (points + bucket_size - 1) / bucket_size;
  return static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(buckets, 1)));
}

}  // namespace

/// Splits points at medians, and fills the boxes and buckets of a tree.
class KdBuild {
 public:
  using Box = KdTree::Box;
  using Points = std::span<IndexedPoint>;

  explicit KdBuild(KdTree& tree) : tree_(tree) {}

  void run(Points points) {
    const float all = infinity;
    tree_.cells_[1] = {{-all, -all, -all, 0}, {all, all, all, 0}};
    // The top is split level by level, then subtrees are independent of each other; what comes out
    // does not depend on who does it.
    std::vector<Points> parts = {points};
    std::uint32_t level = 1;
    for (; level < std::min<std::uint32_t>(tree_.first_leaf_, 16); level *= 2) {
      std::vector<Points> next(2 * level);
      parallel_for(level, 1, [&](std::size_t k, std::size_t) {
        const std::size_t left = split(static_cast<std::uint32_t>(level + k), parts[k]);
        next[2 * k] = parts[k].first(left);
        next[2 * k + 1] = parts[k].subspan(left);
      });
      parts = std::move(next);
    }
    parallel_for(level, 1, [&](std::size_t k, std::size_t) {
      subtree(static_cast<std::uint32_t>(level + k), parts[k]);
    });
    for (std::uint32_t node = level - 1; node > 0; --node) join(node);
  }

 private:
  void subtree(std::uint32_t node, Points points) {
    if (node >= tree_.first_leaf_) {
      fill(node, points);
      return;
    }
    const std::size_t left = split(node, points);
    subtree(2 * node, points.first(left));
    subtree(2 * node + 1, points.subspan(left));
    join(node);
  }

  /// Cuts across the longest side; returns how many points go left.
  std::size_t split(std::uint32_t node, Points points) {
    const Box box = bounds(points);
    std::size_t axis = 0;
    for (const std::size_t other : {1u, 2u})
      if (box.high[other] - box.low[other] > box.high[axis] - box.low[axis]) axis = other;
    const std::size_t left = points.size() / 2;
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(left);
    std::nth_element(points.begin(), middle, points.end(),
                     [axis](const IndexedPoint& a, const IndexedPoint& b) {
                       return a.point[axis] < b.point[axis];
                     });
    tree_.cells_[2 * node] = tree_.cells_[2 * node + 1] = tree_.cells_[node];
    if (!points.empty())
      tree_.cells_[2 * node].high[axis] = tree_.cells_[2 * node + 1].low[axis] =
          middle->point[axis];
    return left;
  }

  static Box bounds(Points points) {
    Box box{{infinity, infinity, infinity, 0}, {-infinity, -infinity, -infinity, 0}};
    for (const IndexedPoint& p : points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], p.point[axis]);
        box.high[axis] = std::max(box.high[axis], p.point[axis]);
      }
    }
    return box;
  }

  void fill(std::uint32_t node, Points points) {
    tree_.boxes_[node] = bounds(points);
    KdTree::Bucket& bucket = tree_.buckets_[node - tree_.first_leaf_];
    bucket.x.fill(infinity);
    bucket.y.fill(infinity);
    bucket.z.fill(infinity);
    bucket.index.fill(no_point);
    for (std::size_t i = 0; i < points.size(); ++i) {
      bucket.x[i] = points[i].point[0];
      bucket.y[i] = points[i].point[1];
      bucket.z[i] = points[i].point[2];
      bucket.index[i] = points[i].index;
    }
  }

  void join(std::uint32_t node) {
    const Box &left = tree_.boxes_[2 * node], &right = tree_.boxes_[2 * node + 1];
    for (std::size_t axis = 0; axis < 4; ++axis) {
      tree_.boxes_[node].low[axis] = std::min(left.low[axis], right.low[axis]);
      tree_.boxes_[node].high[axis] = std::max(left.high[axis], right.high[axis]);
    }
  }

  KdTree& tree_;
};

KdTree::KdTree(std::span<const Eigen::Vector3f> points)
    : size_(points.size()), first_leaf_(leaf_count(points.size(), bucket_size)) {
  std::vector<IndexedPoint> sorted = indexed(points);
  boxes_.resize(2 * first_leaf_);
  cells_.resize(2 * first_leaf_);
  buckets_.resize(first_leaf_);
  KdBuild(*this).run(sorted);
}

std::vector<std::uint32_t> KdTree::number_by_leaf() {
  std::vector<std::uint32_t> old_numbers;
  old_numbers.reserve(size_);
  for (Bucket& bucket : buckets_) {
    for (std::uint32_t& index : bucket.index) {
      if (index == no_point) break;
      old_numbers.push_back(std::exchange(index, static_cast<std::uint32_t>(old_numbers.size())));
    }
  }
  return old_numbers;
}

}  // namespace planum
