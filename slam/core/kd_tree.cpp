#include "slam/core/kd_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace planum {
namespace {

using Four = float __attribute__((vector_size(16)));
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float largest = std::numeric_limits<float>::max();

}  // namespace

/// One walk over a tree, shared by all kinds of queries.
class KdSearch {
 public:
  static constexpr std::size_t bucket_size = KdTree::bucket_size;
  using Distances = std::array<float, bucket_size>;

  KdSearch(const KdTree& tree, const Eigen::Vector3f& query)
      : tree_(tree), query_{query.x(), query.y(), query.z(), 0} {}

  /// Squared distance to the box of a node. Rounded, it never exceeds the rounded squared distance
  /// to a point in the box: every step is monotonous, and the sum has the same order.
  float distance(std::uint32_t node) const {
    const KdTree::Box& box = tree_.boxes_[node];
    const Four query = std::bit_cast<Four>(query_);
    const Four below = std::bit_cast<Four>(box.low) - query;
    const Four above = query - std::bit_cast<Four>(box.high);
    const Four outside = below > above ? below : above;
    const Four gap = outside > Four{} ? outside : Four{};
    const Four squared = gap * gap;
    return squared[0] + squared[1] + squared[2];
  }

  /// Squared distances to all places of a bucket; infinite where there is no point.
  void distances(std::uint32_t leaf, Distances& squared) const {
    const KdTree::Bucket& bucket = bucket_of(leaf);
    for (std::size_t i = 0; i < bucket_size; ++i) {
      const float dx = bucket.x[i] - query_[0], dy = bucket.y[i] - query_[1],
                  dz = bucket.z[i] - query_[2];
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
  }

  /// A point by its place; the distance is what distances() has for it.
  Neighbour at(std::uint32_t leaf, std::uint32_t slot) const {
    const KdTree::Bucket& bucket = bucket_of(leaf);
    const float dx = bucket.x[slot] - query_[0], dy = bucket.y[slot] - query_[1],
                dz = bucket.z[slot] - query_[2];
    return {bucket.index[slot], dx * dx + dy * dy + dz * dz};
  }

  const KdTree::Bucket& bucket_of(std::uint32_t leaf) const {
    return tree_.buckets_[leaf - tree_.first_leaf_];
  }

  /// Calls visit(leaf) for the leaves of a subtree that may hold something within bound(), nearer
  /// halves first, and passed_by(squared distance) for what is left out.
  template <typename Visit, typename Bound, typename PassedBy>
  void descend(std::uint32_t node, const Visit& visit, const Bound& bound,
               const PassedBy& passed_by) const {
    struct Pending {
      std::uint32_t node;
      float distance;
    };
    std::array<Pending, 40> pending;  // one a level at most
    std::size_t count = 0;
    while (true) {
      while (node < tree_.first_leaf_) {
        std::uint32_t near = 2 * node, far = 2 * node + 1;
        float near_distance = distance(near), far_distance = distance(far);
        if (far_distance < near_distance) {
          std::swap(near, far);
          std::swap(near_distance, far_distance);
        }
        if (near_distance > bound()) {
          passed_by(near_distance);
          break;
        }
        if (far_distance <= bound())
          pending[count++] = {far, far_distance};
        else
          passed_by(far_distance);
        node = near;
      }
      if (node >= tree_.first_leaf_) visit(node);
      while (count > 0 && pending[count - 1].distance > bound())
        passed_by(pending[--count].distance);
      if (count == 0) return;
      node = pending[--count].node;
    }
  }

  template <typename Visit, typename Bound>
  void descend(std::uint32_t node, const Visit& visit, const Bound& bound) const {
    descend(node, visit, bound, [](float) {});
  }

  /// The leaf a search without a hint begins with.
  std::uint32_t likely_leaf() const {
    std::uint32_t node = 1;
    while (node < tree_.first_leaf_)
      node = distance(2 * node + 1) < distance(2 * node) ? 2 * node + 1 : 2 * node;
    return node;
  }

  /// Squared distance to the nearest border of the node's part of space: whatever is nearer is in
  /// its subtree. Zero outside of it.
  float squared_margin(std::uint32_t node) const {
    const KdTree::Box& cell = tree_.cells_[node];
    float margin = infinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float below = query_[axis] - cell.low[axis], above = cell.high[axis] - query_[axis];
      margin = std::min(margin, std::min(below, above));
    }
    return margin > 0 ? margin * margin : 0;
  }

  std::uint32_t first_leaf() const { return tree_.first_leaf_; }

 private:
  const KdTree& tree_;
  std::array<float, 4> query_;
};

namespace {

constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

float least_of(const KdSearch::Distances& values) {
  // Floats that are not negative are ordered as their bits are, and integers have a fast minimum.
  std::int32_t least = std::bit_cast<std::int32_t>(infinity);
  for (const float value : values) least = std::min(least, std::bit_cast<std::int32_t>(value));
  return std::bit_cast<float>(least);
}

/// The best point so far of a search for one.
struct Best {
  const KdSearch& search;
  float squared_distance;
  std::uint32_t index = no_index;
  std::uint32_t leaf = 0;  // where it was found

  void visit(std::uint32_t visited) {
    KdSearch::Distances squared;
    search.distances(visited, squared);
    take(visited, squared, least_of(squared));
  }
  std::optional<Neighbour> result() const {
    if (index == no_index) return std::nullopt;
    return Neighbour{index, squared_distance};
  }

 protected:
  /// True if there is a better one in the bucket.
  bool take(std::uint32_t visited, const KdSearch::Distances& squared, float minimum) {
    if (minimum > squared_distance) return false;
    const auto& indices = search.bucket_of(visited).index;
    std::uint32_t lowest = no_index;  // of the points at that distance
    for (std::size_t i = 0; i < squared.size(); ++i)
      lowest = std::min(lowest, squared[i] == minimum ? indices[i] : no_index);
    if (minimum == squared_distance && lowest >= index) return false;
    squared_distance = minimum;
    index = lowest;
    leaf = visited;
    return true;
  }
};

/// The same, and how near any other point may be.
struct BestAndOthers : Best {
  float others = infinity;  // squared

  void visit(std::uint32_t visited) {
    KdSearch::Distances squared;
    search.distances(visited, squared);
    const float minimum = least_of(squared), before = squared_distance;
    const bool had_one = index != no_index;
    if (!take(visited, squared, minimum)) {
      pass_by(minimum);
      return;
    }
    if (had_one) pass_by(before);
    const auto& indices = search.bucket_of(visited).index;
    for (std::size_t i = 0; i < squared.size(); ++i)
      if (indices[i] == index) squared[i] = infinity;
    pass_by(least_of(squared));
  }
  void pass_by(float squared) { others = std::min(others, squared); }

  /// Where in the tree the answer is; where none was found, the leaf that was looked at.
  std::uint32_t place(std::uint32_t looked_at) const {
    if (index == no_index) return looked_at * KdSearch::bucket_size;
    const auto& indices = search.bucket_of(leaf).index;
    std::uint32_t slot = 0;
    while (indices[slot] != index) ++slot;
    return leaf * KdSearch::bucket_size + slot;
  }
};

/// Distances are rounded to some parts in 10^7; so much nearer and farther a true one may be.
constexpr float least_distance = 1 - 4e-6f, most_distance = 1 + 4e-6f;

float squared_bound(float max_distance) { return std::min(max_distance * max_distance, largest); }

}  // namespace

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3f& query, float max_distance) const {
  const KdSearch search(*this, query);
  Best best{.search = search, .squared_distance = squared_bound(max_distance)};
  search.descend(
      1, [&](std::uint32_t leaf) { best.visit(leaf); }, [&] { return best.squared_distance; });
  return best.result();
}

std::optional<Neighbour> KdTree::nearest(const Eigen::Vector3f& query, float max_distance,
                                         SearchMemory& memory) const {
  const KdSearch search(*this, query);
  const float most = squared_bound(max_distance);
  std::uint32_t node = memory.place / bucket_size;
  const bool usable = node >= first_leaf_ && node < 2 * first_leaf_;
  if (usable && memory.others >= 0) {
    const Neighbour last = search.at(node, memory.place % bucket_size);
    const float near = memory.found ? std::min(last.squared_distance, most) : most;
    const float others =
        least_distance * memory.others - (query - memory.query).norm() * most_distance;
    if (others > 0 && others * others > near)
      return memory.found && last.squared_distance <= most ? std::optional(last) : std::nullopt;
  } else if (!usable) {
    node = search.likely_leaf();
  }
  const std::uint32_t first = node;
  BestAndOthers best{{.search = search, .squared_distance = most}};
  best.visit(node);
  while (node > 1) {
    if (const float margin = search.squared_margin(node); margin > best.squared_distance) {
      best.pass_by(margin);
      break;
    }
    const std::uint32_t sibling = node ^ 1;
    if (const float distance = search.distance(sibling); distance <= best.squared_distance) {
      search.descend(
          sibling, [&](std::uint32_t leaf) { best.visit(leaf); },
          [&] { return best.squared_distance; }, [&](float squared) { best.pass_by(squared); });
    } else {
      best.pass_by(distance);
    }
    node /= 2;
  }
  const auto result = best.result();
  memory = {.place = best.place(first),
            .found = result.has_value(),
            .query = query,
            .others = std::sqrt(best.others)};
  return result;
}

void KdTree::k_nearest(const Eigen::Vector3f& query, std::size_t k, std::vector<Neighbour>& result,
                       float max_distance) const {
  result.clear();
  if (k == 0) return;
  const KdSearch search(*this, query);
  float bound = squared_bound(max_distance);
  std::array<std::uint64_t, 64> few;
  std::vector<std::uint64_t> many(k > few.size() ? k : 0);
  const std::span<std::uint64_t> best(k > few.size() ? many.data() : few.data(), k);
  std::size_t count = 0;
  const auto insert = [&](std::uint64_t found) {
    if (count == k && found >= best[k - 1]) return;
    std::size_t at = count < k ? count++ : k - 1;
    for (; at > 0 && found < best[at - 1]; --at) best[at] = best[at - 1];
    best[at] = found;
  };
  const auto visit = [&](std::uint32_t leaf) {
    KdSearch::Distances squared;
    search.distances(leaf, squared);
    const auto& indices = search.bucket_of(leaf).index;
    // Which are near enough cannot be foretold: gathered without branches.
    std::array<std::uint64_t, bucket_size> near;
    std::size_t gathered = 0;
    for (std::size_t i = 0; i < squared.size(); ++i) {
      near[gathered] = Neighbour{indices[i], squared[i]}.rank();
      gathered += squared[i] <= bound;
    }
    for (std::size_t i = 0; i < gathered; ++i) insert(near[i]);
    if (count == k) bound = Neighbour::of_rank(best[k - 1]).squared_distance;
  };
  search.descend(1, visit, [&] { return bound; });
  for (std::size_t i = 0; i < count; ++i) result.push_back(Neighbour::of_rank(best[i]));
}

void KdTree::within(const Eigen::Vector3f& query, float radius,
                    std::vector<Neighbour>& result) const {
  result.clear();
  const KdSearch search(*this, query);
  const float bound = squared_bound(radius);
  const auto visit = [&](std::uint32_t leaf) {
    KdSearch::Distances squared;
    search.distances(leaf, squared);
    const auto& indices = search.bucket_of(leaf).index;
    for (std::size_t i = 0; i < squared.size(); ++i)
      if (squared[i] <= bound) result.push_back({indices[i], squared[i]});
  };
  search.descend(1, visit, [&] { return bound; });
  std::sort(result.begin(), result.end());
}

}  // namespace planum
