#include "tools/maps/octree_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace planum {
namespace {

/// A part of the tree as its parent sees it.
template <class Value>
struct Branch {
  enum Kind { unknown, leaf, inner } kind = unknown;
  Value value = {};
};

/// Each node is its log odds and a byte of the children it has; the children follow it.
struct LogOddsFormat {
  using Value = float;
  static constexpr std::size_t head_size = 5;
  static Value value_of(float log_odds) { return log_odds; }

  static void add_leaf(std::string& nodes, Value value) {
    nodes.resize(nodes.size() + head_size);
    std::memcpy(&nodes[nodes.size() - head_size], &value, 4);
  }

  /// Returns the value of the node: that of its likeliest child.
  static Value finish(char* head, const std::array<Branch<Value>, 8>& children) {
    float most = -HUGE_VALF;
    unsigned has = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      if (children[i].kind == Branch<Value>::unknown) continue;
      most = std::max(most, children[i].value);
      has |= 1U << i;
    }
    std::memcpy(head, &most, 4);
    head[4] = static_cast<char>(has);
    return most;
  }
};

/// Each node with children is two bits a child: unknown, free, occupied, or a node that follows it.
struct BinaryFormat {
  using Value = bool;
  static constexpr std::size_t head_size = 2;
  static Value value_of(float log_odds) { return log_odds >= 0; }
  static void add_leaf(std::string&, Value) {}

  static Value finish(char* head, const std::array<Branch<Value>, 8>& children) {
    unsigned bits = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const Branch<Value>& child = children[i];
      const unsigned kind = child.kind == Branch<Value>::unknown ? 0U
                            : child.kind == Branch<Value>::inner ? 3U
                            : child.value                        ? 2U
                                                                 : 1U;
      bits |= kind << (2 * i);
    }
    head[0] = static_cast<char>(bits & 0xff);
    head[1] = static_cast<char>(bits >> 8);
    return true;
  }
};

/// The nodes of a tree, each before its children; what turns out to be one leaf is taken back.
template <class Format>
class Tree {
 public:
  explicit Tree(std::span<const BrickOdds* const> bricks) {
    if (!bricks.empty()) add_bricks(bricks, bricks_levels);
  }

  const std::string& nodes() const { return nodes_; }
  std::size_t count() const { return count_; }

 private:
  using Value = typename Format::Value;
  using Part = Branch<Value>;

  Part add_bricks(std::span<const BrickOdds* const> bricks, int levels) {
    if (levels == 0) return add_cells(*bricks.front(), 0, cells_per_brick);
    const int below = 3 * (levels - 1);
    const std::size_t head = begin_node();
    std::array<Part, 8> children = {};
    for (std::size_t begin = 0, end = 0; begin < bricks.size(); begin = end) {
      const std::uint64_t branch = bricks[begin]->path >> below;
      while (end < bricks.size() && bricks[end]->path >> below == branch) ++end;
      children[branch & 7] = add_bricks(bricks.subspan(begin, end - begin), levels - 1);
    }
    return end_node(head, children);
  }

  /// `count` cells of a brick, of which at least one is known.
  Part add_cells(const BrickOdds& brick, std::size_t first, std::size_t count) {
    if (count == 1) return add_leaf(Format::value_of(brick.log_odds[first]));
    const std::size_t head = begin_node(), step = count / 8;
    std::array<Part, 8> children = {};
    for (std::size_t child = 0; child < 8; ++child)
      if (const std::size_t cell = first + child * step; brick.known.has_any(cell, step))
        children[child] = add_cells(brick, cell, step);
    return end_node(head, children);
  }

  Part add_leaf(Value value) {
    ++count_;
    Format::add_leaf(nodes_, value);
    return {Part::leaf, value};
  }

  std::size_t begin_node() {
    ++count_;
    nodes_.resize(nodes_.size() + Format::head_size);
    return nodes_.size() - Format::head_size;
  }

  Part end_node(std::size_t head, const std::array<Part, 8>& children) {
    const Part& first = children.front();
    if (first.kind == Part::leaf &&
        std::all_of(children.begin(), children.end(), [&](const Part& child) {
          return child.kind == Part::leaf && child.value == first.value;
        })) {
      nodes_.resize(head);
      count_ -= 9;
      return add_leaf(first.value);
    }
    return {Part::inner, Format::finish(&nodes_[head], children)};
  }

  std::string nodes_;
  std::size_t count_ = 0;
};

template <class Format>
std::string file_of(const char* kind, std::span<const BrickOdds* const> bricks, double cell) {
  const Tree<Format> tree(bricks);
  return fmt::format("# Octomap OcTree {}\n# written by planum\nid OcTree\nsize {}\nres {}\ndata\n",
                     kind, tree.count(), cell) +
         tree.nodes();
}

}  // namespace

std::string octree_file(std::span<const BrickOdds* const> bricks, double cell) {
  return file_of<LogOddsFormat>("file", bricks, cell);
}

std::string binary_octree_file(std::span<const BrickOdds* const> bricks, double cell) {
  return file_of<BinaryFormat>("binary file", bricks, cell);
}

}  // namespace planum
