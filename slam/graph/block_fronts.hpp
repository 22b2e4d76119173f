#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace planum {

/// Two different blocks that a term joins; the lower one first.
using BlockPair = std::pair<std::uint32_t, std::uint32_t>;

/// Where an off-diagonal block of the matrix goes in a front.
struct FrontEntry {
  std::uint32_t pair = 0;             ///< which one of the matrix
  std::uint32_t row = 0, column = 0;  ///< block position in the front, row > column
  bool transposed = false;            ///< the matrix has it as (column, row)
};

/// A dense part of the factor: some columns that are eliminated together, and the rows below them.
struct Front {
  std::uint32_t first_column = 0;   ///< in the order of elimination
  std::uint32_t columns = 0;        ///< blocks
  std::vector<std::uint32_t> rows;  ///< below the columns, ascending, in the order of elimination
  std::int32_t parent = -1;         ///< front that takes the rest of this one; -1: none
  std::vector<std::uint32_t> children;   ///< ascending
  std::vector<std::uint32_t> in_parent;  ///< for each row, its block position in the parent
  std::vector<FrontEntry> entries;       ///< of the matrix, with their column in this front

  std::size_t size() const { return columns + rows.size(); }  ///< blocks
};

/// How a symmetric matrix of blocks is eliminated: an order with little fill-in (the better of
/// minimum degree and nested dissection, by CHOLMOD), and its columns gathered into dense fronts.
struct FrontTree {
  std::size_t pairs = 0;             ///< off-diagonal blocks of the matrix
  std::vector<std::uint32_t> order;  ///< order[k]: the block that is eliminated k-th
  std::vector<Front> fronts;         ///< children before parents
  /// Disjoint subtrees of similar work, each a range [begin, end) of fronts, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> subtrees;
};

/// Analyses a matrix of `blocks` blocks with the given off-diagonal ones (each pair once).
FrontTree analyzed_fronts(std::size_t blocks, std::span<const BlockPair> pairs);

}  // namespace planum
