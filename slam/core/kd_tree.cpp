#include "slam/core/kd_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::uint32_t bucket_size = 16;
constexpr float infinity = std::numeric_limits<float>::infinity();

struct IndexedPoint {
  Eigen::Vector3f point;
  std::uint32_t index;
};

std::vector<IndexedPoint> indexed(std::span<const Eigen::Vector3f> points) {
  std::vector<IndexedPoint> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw Error(fmt::format("search tree: point {} is not finite ({}, {}, {})", i, points[i].x(),
                              points[i].y(), points[i].z()));
    result[i] = {points[i], static_cast<std::uint32_t>(i)};
  }
  return result;
}

/// Leaves of a complete tree in which no leaf holds more than a bucket.
std::uint32_t leaf_count(std::size_t points) {
  const std::size_t buckets = (points + bucket_size - 1) / bucket_size;
  return static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(buckets, 1)));
}

/// Squared distance from a point to a box. Rounded, it never exceeds the rounded squared distance
/// to a point in the box: each step is monotonous. (Contraction to fma is off in the whole
/// project.)
float squared_distance(const Eigen::Array3f& low, const Eigen::Array3f& high,
                       const Eigen::Vector3f& p) {
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float gap = std::max({low[axis] - p[axis], p[axis] - high[axis], 0.0f});
    sum += gap * gap;
  }
  return sum;
}

}  // namespace

KdTree::KdTree(std::span<const Eigen::Vector3f> points) : first_leaf_(leaf_count(points.size())) {
  std::vector<IndexedPoint> sorted = indexed(points);
  const std::uint32_t node_count = 2 * first_leaf_;
  boxes_.resize(node_count);
  cells_.resize(node_count);
  const Eigen::Array3f everything = Eigen::Array3f::Constant(infinity);
  cells_[1] = {-everything, everything};

  // Level by level: the nodes of a level are independent, and so is the result of who splits them.
  std::vector<std::uint32_t> begins = {0, static_cast<std::uint32_t>(points.size())};
  for (std::uint32_t level = 1; level < first_leaf_; level *= 2) {
    std::vector<std::uint32_t> next(2 * level + 1);
    next.back() = begins.back();
    parallel_for(level, 1, [&](std::size_t k, std::size_t) {
      const auto first = sorted.begin() + begins[k], last = sorted.begin() + begins[k + 1];
      Eigen::Array3f low = everything, high = -everything;
      for (auto p = first; p != last; ++p) {
        low = low.min(p->point.array());
        high = high.max(p->point.array());
      }
      int axis = 0;
      (high - low).maxCoeff(&axis);
      const auto middle = first + (last - first) / 2;
      std::nth_element(first, middle, last, [axis](const IndexedPoint& a, const IndexedPoint& b) {
        return a.point[axis] != b.point[axis] ? a.point[axis] < b.point[axis] : a.index < b.index;
      });
      next[2 * k] = begins[k];
      next[2 * k + 1] = static_cast<std::uint32_t>(middle - sorted.begin());
      const std::size_t node = level + k;
      cells_[2 * node] = cells_[2 * node + 1] = cells_[node];
      if (middle != last)
        cells_[2 * node].high[axis] = cells_[2 * node + 1].low[axis] = middle->point[axis];
    });
    begins = std::move(next);
  }
  leaf_begin_ = std::move(begins);

  x_.resize(points.size());
  y_.resize(points.size());
  z_.resize(points.size());
  indices_.resize(points.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    x_[i] = sorted[i].point.x();
    y_[i] = sorted[i].point.y();
    z_[i] = sorted[i].point.z();
    indices_[i] = sorted[i].index;
  }

  for (std::uint32_t leaf = 0; leaf < first_leaf_; ++leaf) {
    Box box{everything, -everything};
    for (std::uint32_t i = leaf_begin_[leaf]; i < leaf_begin_[leaf + 1]; ++i) {
      box.low = box.low.min(sorted[i].point.array());
      box.high = box.high.max(sorted[i].point.array());
    }
    boxes_[first_leaf_ + leaf] = box;
  }
  for (std::uint32_t node = first_leaf_ - 1; node > 0; --node) {
    boxes_[node] = {boxes_[2 * node].low.min(boxes_[2 * node + 1].low),
                    boxes_[2 * node].high.max(boxes_[2 * node + 1].high)};
  }
}

/// One walk over a tree, shared by all kinds of queries.
class KdSearch {
 public:
  KdSearch(const KdTree& tree, const Eigen::Vector3f& query) : tree_(tree), query_(query) {}

  /// Calls take(position, squared distance) for points of leaves that may hold something within
  /// bound(), nearer halves first, in the subtree of `node`.
  template <typename Take, typename Bound>
  void descend(std::uint32_t node, const Take& take, const Bound& bound) const {
    if (node >= tree_.first_leaf_) {
      scan(node, take);
      return;
    }
    std::uint32_t near = 2 * node, far = 2 * node + 1;
    float near_distance = distance(near), far_distance = distance(far);
    if (far_distance < near_distance) {
      std::swap(near, far);
      std::swap(near_distance, far_distance);
    }
    if (near_distance <= bound()) descend(near, take, bound);
    if (far_distance <= bound()) descend(far, take, bound);
  }

  /// The leaf a search without a hint begins with.
  std::uint32_t likely_leaf() const {
    std::uint32_t node = 1;
    while (node < tree_.first_leaf_)
      node = distance(2 * node + 1) < distance(2 * node) ? 2 * node + 1 : 2 * node;
    return node;
  }

  template <typename Take>
  void scan(std::uint32_t node, const Take& take) const {
    const std::uint32_t begin = tree_.leaf_begin_[node - tree_.first_leaf_];
    const std::uint32_t count = tree_.leaf_begin_[node - tree_.first_leaf_ + 1] - begin;
    const float *x = &tree_.x_[begin], *y = &tree_.y_[begin], *z = &tree_.z_[begin];
    std::array<float, bucket_size> squared;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float dx = x[i] - query_.x(), dy = y[i] - query_.y(), dz = z[i] - query_.z();
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
    for (std::uint32_t i = 0; i < count; ++i) take(begin + i, squared[i]);
  }

  float distance(std::uint32_t node) const {
    const KdTree::Box& box = tree_.boxes_[node];
    return squared_distance(box.low, box.high, query_);
  }

  /// Whether every point within sqrt(squared_radius) of the query must be in the node's subtree.
  bool answers_for(std::uint32_t node, float squared_radius) const {
    const KdTree::Box& cell = tree_.cells_[node];
    for (int axis = 0; axis < 3; ++axis) {
      const float below = query_[axis] - cell.low[axis], above = cell.high[axis] - query_[axis];
      if (!(below > 0 && below * below > squared_radius)) return false;
      if (!(above > 0 && above * above > squared_radius)) return false;
    }
    return true;
  }

 private:
  const KdTree& tree_;
  const Eigen::Vector3f& query_;
};

namespace {

/// The best point so far of a search for one.
struct Best {
  const std::vector<std::uint32_t>& indices;
  float squared_distance;
  std::uint32_t index = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t position = std::numeric_limits<std::uint32_t>::max();

  void take(std::uint32_t at, float squared) {
    if (squared > squared_distance) return;
    if (squared == squared_distance && indices[at] > index) return;
    squared_distance = squared;
    index = indices[at];
    position = at;
  }
  std::optional<Neighbour> result() const {
    if (position == std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
    return Neighbour{index, squared_distance};
  }
};

}  // namespace

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3f& query, float max_distance) const {
  if (indices_.empty()) return std::nullopt;
  const KdSearch search(*this, query);
  Best best{.indices = indices_, .squared_distance = max_distance * max_distance};
  search.descend(
      1, [&](std::uint32_t at, float squared) { best.take(at, squared); },
      [&] { return best.squared_distance; });
  return best.result();
}

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3f& query, float max_distance,
                                         std::uint32_t& leaf_hint) const {
  if (indices_.empty()) return std::nullopt;
  const KdSearch search(*this, query);
  Best best{.indices = indices_, .squared_distance = max_distance * max_distance};
  const auto take = [&](std::uint32_t at, float squared) { best.take(at, squared); };
  const auto bound = [&] { return best.squared_distance; };
  const bool usable = leaf_hint >= first_leaf_ && leaf_hint < 2 * first_leaf_;
  std::uint32_t node = usable ? leaf_hint : search.likely_leaf();
  std::uint32_t ended = node, last_position = best.position;
  const auto keep_leaf = [&](std::uint32_t subtree) {
    if (best.position == last_position) return;
    last_position = best.position;
    ended = subtree;
  };
  search.scan(node, take);
  keep_leaf(node);
  while (node > 1 && !search.answers_for(node, best.squared_distance)) {
    const std::uint32_t sibling = node ^ 1;
    if (search.distance(sibling) <= best.squared_distance) search.descend(sibling, take, bound);
    keep_leaf(sibling);
    node /= 2;
  }
  if (ended < first_leaf_) {  // found somewhere below a sibling: its leaf follows from the position
    const auto after = std::upper_bound(leaf_begin_.begin(), leaf_begin_.end(), best.position);
    ended = first_leaf_ + static_cast<std::uint32_t>(after - leaf_begin_.begin()) - 1;
  }
  leaf_hint = ended;
  return best.result();
}

void KdTree::k_nearest(const Eigen::Vector3f& query, std::size_t k, std::vector<Neighbour>& result,
                       float max_distance) const {
  result.clear();
  if (k == 0 || indices_.empty()) return;
  const KdSearch search(*this, query);
  float bound = max_distance * max_distance;
  search.descend(
      1,
      [&](std::uint32_t at, float squared) {
        if (squared > bound) return;
        const Neighbour found{indices_[at], squared};
        if (result.size() == k) {
          if (!(found < result.front())) return;
          std::pop_heap(result.begin(), result.end());
          result.back() = found;
        } else {
          result.push_back(found);
        }
        std::push_heap(result.begin(), result.end());
        if (result.size() == k) bound = result.front().squared_distance;
      },
      [&] { return bound; });
  std::sort_heap(result.begin(), result.end());
}

void KdTree::within(const Eigen::Vector3f& query, float radius,
                    std::vector<Neighbour>& result) const {
  result.clear();
  if (indices_.empty()) return;
  const KdSearch search(*this, query);
  const float bound = radius * radius;
  search.descend(
      1,
      [&](std::uint32_t at, float squared) {
        if (squared <= bound) result.push_back({indices_[at], squared});
      },
      [&] { return bound; });
  std::sort(result.begin(), result.end());
}

}  // namespace planum
