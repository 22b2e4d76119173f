#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace planum {

/// An order of elimination with little fill-in for a symmetric matrix whose off-diagonal non-zeros
/// are `pairs`: the better of approximate minimum degree and nested dissection, as CHOLMOD counts
/// them; postordered. Result k is the row that is eliminated k-th.
std::vector<std::uint32_t> elimination_order(
    std::size_t rows, std::span<const std::pair<std::uint32_t, std::uint32_t>> pairs);

}  // namespace planum
