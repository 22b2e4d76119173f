#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "slam/graph/block_fronts.hpp"

namespace planum {

/// Which poses the edges of a graph join, analysed once for all linear systems over it.
struct GraphPattern {
  static constexpr std::uint32_t no_pair = std::numeric_limits<std::uint32_t>::max();

  std::vector<BlockPair> pairs;             ///< each once, ascending
  std::vector<std::uint32_t> pair_of_edge;  ///< several edges may join the same poses
  std::shared_ptr<const FrontTree> tree;
};

/// The pattern of some edges of a graph, in space or in the plane; the others have no_pair. No edge
/// may join a pose with itself.
template <class Graph>
GraphPattern graph_pattern(const Graph& graph, const std::vector<bool>& included) {
  GraphPattern pattern;
  const auto pair_of = [&](std::size_t edge) {
    const auto from = static_cast<std::uint32_t>(graph.edges[edge].from);
    const auto to = static_cast<std::uint32_t>(graph.edges[edge].to);
    return BlockPair(std::min(from, to), std::max(from, to));
  };
  for (std::size_t i = 0; i < graph.edges.size(); ++i)
    if (included[i]) pattern.pairs.push_back(pair_of(i));
  std::sort(pattern.pairs.begin(), pattern.pairs.end());
  pattern.pairs.erase(std::unique(pattern.pairs.begin(), pattern.pairs.end()), pattern.pairs.end());
  pattern.pair_of_edge.assign(graph.edges.size(), GraphPattern::no_pair);
  for (std::size_t i = 0; i < graph.edges.size(); ++i) {
    if (!included[i]) continue;
    const auto at = std::lower_bound(pattern.pairs.begin(), pattern.pairs.end(), pair_of(i));
    pattern.pair_of_edge[i] = static_cast<std::uint32_t>(at - pattern.pairs.begin());
  }
  pattern.tree = std::make_shared<FrontTree>(analyzed_fronts(graph.poses.size(), pattern.pairs));
  return pattern;
}

}  // namespace planum
