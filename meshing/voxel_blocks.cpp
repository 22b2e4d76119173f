#include "meshing/voxel_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_task = 1 << 15;
constexpr std::size_t most_chunks = 64;

std::size_t hash(CellKey key) { return (key * 0x9e3779b97f4a7c15ull) >> 24; }

/// Multiples of this many cells are where lattices may begin.
constexpr double origin_step = 128;

/// The distinct blocks of consecutive cells; neighbours in the input are mostly in the same block.
std::vector<CellKey> distinct_blocks(std::span<const CellKey> cells) {
  std::vector<CellKey> keys;
  CellKey last = no_cell;
  for (const CellKey cell : cells) {
    if (cell == no_cell || block_of(cell) == last) continue;
    last = block_of(cell);
    keys.push_back(last);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// Counting sort of the items of one block by their cell; keeps the order within a cell.
void sort_block(std::span<const CellKey> cells, std::span<std::uint32_t> items,
                std::vector<std::uint32_t>& scratch) {
  std::array<std::uint32_t, block_cells + 1> first{};
  for (const std::uint32_t i : items) ++first[std::size_t(cell_in_block(cells[i])) + 1];
  for (std::size_t c = 0; c < block_cells; ++c) first[c + 1] += first[c];
  scratch.assign(items.begin(), items.end());
  for (const std::uint32_t i : scratch) items[first[std::size_t(cell_in_block(cells[i]))]++] = i;
}

}  // namespace

CellKey Lattice::key(const Eigen::Vector3d& point) const {
  const Eigen::Array3d c = ((point - origin) / size).array().floor();
  // Cells at the rim are left free, so that a neighbour of a cell always has a key.
  constexpr double limit = cell_limit - 2 * block_width;
  if (!((c > -limit).all() && (c < limit).all())) return no_cell;
  return cell_key(int(c.x()), int(c.y()), int(c.z()));
}

Lattice lattice_around(std::span<const Eigen::Vector3f> points, double size) {
  Lattice lattice{.size = size};
  if (points.empty()) return lattice;
  const std::size_t step = std::max<std::size_t>(1, points.size() / 4096);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> sample;
    for (std::size_t i = 0; i < points.size(); i += step)
      if (std::isfinite(points[i][axis])) sample.push_back(points[i][axis]);
    if (sample.empty()) continue;
    const auto middle = sample.begin() + std::ptrdiff_t(sample.size() / 2);
    std::nth_element(sample.begin(), middle, sample.end());
    lattice.origin[axis] = std::round(*middle / (origin_step * size)) * origin_step * size;
  }
  return lattice;
}

std::vector<CellKey> cell_keys(const Lattice& lattice, std::span<const Eigen::Vector3f> points) {
  std::vector<CellKey> keys(points.size());
  parallel_for(points.size(), points_per_task, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!points[i].allFinite())
        throw Error("point " + std::to_string(i) + " of " + std::to_string(points.size()) +
                    " is not finite");
      keys[i] = lattice.key(points[i].cast<double>());
    }
  });
  return keys;
}

BlockSet::BlockSet(std::vector<CellKey> keys) : keys_(std::move(keys)) {
  std::sort(keys_.begin(), keys_.end());
  keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  std::size_t room = 16;
  while (room < 2 * keys_.size()) room *= 2;
  table_.assign(room, no_block);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    std::size_t slot = hash(keys_[i]) & (room - 1);
    while (table_[slot] != no_block) slot = (slot + 1) & (room - 1);
    table_[slot] = std::uint32_t(i);
  }
}

std::uint32_t BlockSet::find(CellKey block_key) const {
  if (table_.empty()) return no_block;
  const std::size_t mask = table_.size() - 1;
  for (std::size_t slot = hash(block_key) & mask;; slot = (slot + 1) & mask) {
    const std::uint32_t block = table_[slot];
    if (block == no_block || keys_[block] == block_key) return block;
  }
}

std::array<std::uint32_t, 27> BlockSet::neighbourhood(CellKey block) const {
  const Eigen::Vector3i cell = cell_of(block);
  std::array<std::uint32_t, 27> result;
  std::size_t n = 0;
  for (int z = -block_width; z <= block_width; z += block_width)
    for (int y = -block_width; y <= block_width; y += block_width)
      for (int x = -block_width; x <= block_width; x += block_width)
        result[n++] = find(cell_key(cell.x() + x, cell.y() + y, cell.z() + z));
  return result;
}

CellSort sort_by_cell(std::span<const CellKey> cells) {
  // Chunks do not depend on the number of threads; each writes behind the one before it.
  const std::size_t chunk_size = std::max(points_per_task, cells.size() / most_chunks + 1);
  const std::size_t chunks = (cells.size() + chunk_size - 1) / chunk_size;
  std::vector<std::vector<CellKey>> distinct(chunks);
  parallel_for(cells.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
    distinct[begin / chunk_size] = distinct_blocks(cells.subspan(begin, end - begin));
  });
  std::vector<CellKey> keys;
  for (const auto& some : distinct) keys.insert(keys.end(), some.begin(), some.end());

  CellSort result;
  result.blocks = BlockSet(std::move(keys));
  const std::size_t blocks = result.blocks.size();
  std::vector<std::uint32_t> block(cells.size(), no_block);
  std::vector<std::uint32_t> places(chunks * blocks, 0);
  parallel_for(cells.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* counts = places.data() + begin / chunk_size * blocks;
    CellKey last = no_cell;
    std::uint32_t found = no_block;
    for (std::size_t i = begin; i < end; ++i) {
      if (cells[i] == no_cell) continue;
      if (block_of(cells[i]) != last) found = result.blocks.find(last = block_of(cells[i]));
      block[i] = found;
      ++counts[found];
    }
  });
  result.begin.resize(blocks + 1);
  std::uint32_t total = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    result.begin[b] = total;
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::uint32_t count = places[c * blocks + b];
      places[c * blocks + b] = total;
      total += count;
    }
  }
  result.begin[blocks] = total;
  result.order.resize(total);
  parallel_for(cells.size(), chunk_size, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* place = places.data() + begin / chunk_size * blocks;
    for (std::size_t i = begin; i < end; ++i)
      if (block[i] != no_block) result.order[place[block[i]]++] = std::uint32_t(i);
  });
  parallel_for(blocks, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> scratch;
    for (std::size_t b = begin; b < end; ++b)
      sort_block(
          cells,
          std::span(result.order).subspan(result.begin[b], result.begin[b + 1] - result.begin[b]),
          scratch);
  });
  return result;
}

void surrounding_cells(const BlockSet& blocks, std::span<const std::uint32_t> begin,
                       std::span<const CellKey> cells, CellKey block, int margin,
                       std::vector<std::uint32_t>& first) {
  const int width = block_width + 2 * margin;
  first.assign(std::size_t(width) * std::size_t(width) * std::size_t(width), no_thing);
  const Eigen::Vector3i corner = cell_of(block) - Eigen::Vector3i::Constant(margin);
  for (const std::uint32_t neighbour : blocks.neighbourhood(block)) {
    if (neighbour == no_block) continue;
    for (std::uint32_t thing = begin[neighbour + 1]; thing-- > begin[neighbour];) {
      const Eigen::Vector3i at = cell_of(cells[thing]) - corner;
      if ((at.array() < 0).any() || (at.array() >= width).any()) continue;
      first[std::size_t((at.z() * width + at.y()) * width + at.x())] = thing;
    }
  }
}

}  // namespace planum
