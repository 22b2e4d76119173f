#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace planum {

/// Some items of each cell, as one list with offsets.
class CellLists {
 public:
  /// From pairs (cell, item); each list is ascending and without repetition.
  CellLists(std::size_t cells, std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs)
      : first_(cells + 1, 0) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    items_.reserve(pairs.size());
    for (const auto& [cell, item] : pairs) {
      ++first_[cell + 1];
      items_.push_back(item);
    }
    for (std::size_t i = 0; i < cells; ++i) first_[i + 1] += first_[i];
  }

  std::span<const std::uint32_t> at(std::size_t cell) const {
    return std::span(items_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> items_;
};

}  // namespace planum
