#include "slam/graph/block_fronts.hpp"

#include <algorithm>
#include <numeric>

#include "slam/graph/elimination_order.hpp"

namespace planum {
namespace {

using Indices = std::vector<std::uint32_t>;

/// The rows of each column of the factor below its diagonal, ascending: those of the matrix and
/// those that its children in the elimination tree leave over.
std::vector<Indices> factor_rows(std::size_t blocks, std::span<const BlockPair> pairs,
                                 const Indices& position) {
  std::vector<Indices> rows(blocks), children(blocks);
  for (const auto& [a, b] : pairs) {
    const auto [low, high] = std::minmax(position[a], position[b]);
    rows[low].push_back(high);
  }
  for (std::uint32_t column = 0; column < blocks; ++column) {
    Indices& own = rows[column];
    std::sort(own.begin(), own.end());
    for (const std::uint32_t child : children[column]) {
      Indices united;
      united.reserve(own.size() + rows[child].size());
      std::set_union(own.begin(), own.end(), rows[child].begin() + 1, rows[child].end(),
                     std::back_inserter(united));
      own = std::move(united);
    }
    if (!own.empty()) children[own.front()].push_back(column);
  }
  return rows;
}

/// Whether a front of so many columns may hold this share of explicit zeros: few columns are slow
/// anyway, many must be worth it. The limits are of the same kind as CHOLMOD's.
bool worth_merging(std::size_t columns, double zero_share) {
  if (columns <= 2) return true;
  if (columns <= 4) return zero_share < 0.6;
  if (columns <= 8) return zero_share < 0.3;
  if (columns <= 16) return zero_share < 0.1;
  return zero_share < 0.05;
}

/// First columns of the fronts: neighbours in the elimination tree are merged, from the end, where
/// that adds few zeros.
Indices front_starts(const std::vector<Indices>& rows) {
  const auto blocks = static_cast<std::uint32_t>(rows.size());
  Indices starts;
  std::uint32_t end = blocks;  // [column + 1, end) is the front that grows
  double non_zeros = 0;
  for (std::uint32_t column = blocks; column-- > 0;) {
    const double own = 1.0 + static_cast<double>(rows[column].size());
    if (column + 1 < end) {
      const double columns = end - column;
      const double total =
          columns * ((columns + 1) / 2 + static_cast<double>(rows[end - 1].size()));
      const bool is_child = !rows[column].empty() && rows[column].front() == column + 1;
      if (!is_child || !worth_merging(end - column, (total - non_zeros - own) / total)) {
        starts.push_back(column + 1);
        end = column + 1;
        non_zeros = 0;
      }
    }
    non_zeros += own;
  }
  if (blocks > 0) starts.push_back(0);
  std::reverse(starts.begin(), starts.end());
  return starts;
}

/// Position of a block row in a front.
std::uint32_t local(const Front& front, std::uint32_t row) {
  if (row < front.first_column + front.columns) return row - front.first_column;
  const auto at = std::lower_bound(front.rows.begin(), front.rows.end(), row);
  return front.columns + static_cast<std::uint32_t>(at - front.rows.begin());
}

/// Cuts the tree into subtrees none of which has more than a share of all work; what is above them
/// is done after them. A function of the tree alone.
std::vector<std::pair<std::uint32_t, std::uint32_t>> balanced_subtrees(
    const std::vector<Front>& fronts) {
  constexpr double share = 1.0 / 16;
  std::vector<double> work(fronts.size(), 0);
  std::vector<std::uint32_t> first(fronts.size());  // descendant; the fronts are in postorder
  Indices open;
  double total = 0;
  for (std::uint32_t f = 0; f < fronts.size(); ++f) {
    const auto size = static_cast<double>(fronts[f].size());
    const double own = fronts[f].columns * size * size;
    total += own;
    work[f] += own;
    first[f] = fronts[f].children.empty() ? f : first[fronts[f].children.front()];
    if (fronts[f].parent >= 0)
      work[static_cast<std::size_t>(fronts[f].parent)] += work[f];
    else
      open.push_back(f);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> subtrees;
  while (!open.empty()) {
    const std::uint32_t f = open.back();
    open.pop_back();
    if (work[f] <= share * total)
      subtrees.emplace_back(first[f], f + 1);
    else
      open.insert(open.end(), fronts[f].children.begin(), fronts[f].children.end());
  }
  std::sort(subtrees.begin(), subtrees.end());
  return subtrees;
}

}  // namespace

FrontTree analyzed_fronts(std::size_t blocks, std::span<const BlockPair> pairs) {
  FrontTree tree;
  tree.pairs = pairs.size();
  tree.order = elimination_order(blocks, pairs);
  Indices position(blocks), front_of(blocks);
  for (std::uint32_t k = 0; k < blocks; ++k) position[tree.order[k]] = k;
  const std::vector<Indices> rows = factor_rows(blocks, pairs, position);

  const Indices starts = front_starts(rows);
  tree.fronts.resize(starts.size());
  for (std::uint32_t f = 0; f < starts.size(); ++f) {
    const auto end = f + 1 < starts.size() ? starts[f + 1] : static_cast<std::uint32_t>(blocks);
    tree.fronts[f].first_column = starts[f];
    tree.fronts[f].columns = end - starts[f];
    tree.fronts[f].rows = rows[end - 1];
    std::fill(front_of.begin() + starts[f], front_of.begin() + end, f);
  }
  for (std::uint32_t f = 0; f < tree.fronts.size(); ++f) {
    Front& front = tree.fronts[f];
    if (front.rows.empty()) continue;
    const std::uint32_t parent = front_of[front.rows.front()];
    front.parent = static_cast<std::int32_t>(parent);
    tree.fronts[parent].children.push_back(f);
    for (const std::uint32_t row : front.rows)
      front.in_parent.push_back(local(tree.fronts[parent], row));
  }
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    const std::uint32_t first = position[pairs[k].first], second = position[pairs[k].second];
    const auto [column, row] = std::minmax(first, second);
    Front& front = tree.fronts[front_of[column]];
    front.entries.push_back({.pair = k,
                             .row = local(front, row),
                             .column = column - front.first_column,
                             .transposed = first < second});
  }
  tree.subtrees = balanced_subtrees(tree.fronts);
  return tree;
}

}  // namespace planum
