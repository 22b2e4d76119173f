#include "meshing/surface_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 16;
constexpr std::size_t most_patches = 4;  // in one cell
constexpr float same_direction = 0.7f;   // cosine, about 45 degrees

/// Sums over the points of a patch in the making.
struct PatchSum {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< relative to the lattice's origin
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float count = 0;
};

/// Puts a point to the first patch that faces its way, or else makes a new one.
void add_point(const Eigen::Vector3d& point, const Eigen::Vector3f& normal,
               std::array<PatchSum, most_patches>& sums, std::size_t& used) {
  std::size_t best = 0;
  float best_cosine = -2;
  for (std::size_t k = 0; k < used; ++k) {
    const float cosine = sums[k].normal.dot(normal) / std::max(sums[k].normal.norm(), 1e-6f);
    if (cosine > best_cosine) best = k, best_cosine = cosine;
  }
  if (best_cosine < same_direction && used < most_patches) best = used++;
  sums[best].point += point;
  sums[best].normal += normal;
  sums[best].count += 1;
}

/// Patches and their cells, of some blocks.
struct PatchList {
  std::vector<SurfacePatch> patches;
  std::vector<CellKey> cells;
  std::vector<Occupancy> occupied;
};

/// The part of its cell that a point is in; coordinates in cells.
Occupancy part_of(const Eigen::Vector3d& point) {
  const Eigen::Array3i part =
      ((point.array() - point.array().floor()) * parts_of_cell).cast<int>().min(parts_of_cell - 1);
  return Occupancy{1} << (part.x() + parts_of_cell * (part.y() + parts_of_cell * part.z()));
}

void add_patches(const std::array<PatchSum, most_patches>& sums, std::size_t used, CellKey cell,
                 Occupancy occupied, PatchList& list) {
  for (std::size_t k = 0; k < used; ++k) {
    const PatchSum& sum = sums[k];
    if (sum.normal.norm() < 0.5f * sum.count) continue;  // points that do not agree
    list.patches.push_back({.centre = sum.point / double(sum.count),
                            .normal = sum.normal.normalized(),
                            .count = sum.count});
    list.cells.push_back(cell);
    list.occupied.push_back(occupied);
  }
}

/// Whether enough of the points in the 3 x 3 x 3 cells around a patch lie on its plane.
bool has_support(const SurfacePatches& all, std::uint32_t self, const Eigen::Vector3i& at,
                 const std::vector<std::uint32_t>& first) {
  constexpr float least_share = 0.1f;
  constexpr float same_plane = 0.94f;  // cosine, about 20 degrees
  constexpr double same_layer = 0.6;   // cells
  constexpr int width = block_width + 2;
  const SurfacePatch& own = all.patches[self];
  float agreeing = 0, points = 0;
  for (int z = at.z(); z < at.z() + 3; ++z)
    for (int y = at.y(); y < at.y() + 3; ++y)
      for (int x = at.x(); x < at.x() + 3; ++x) {
        std::uint32_t k = first[std::size_t((z * width + y) * width + x)];
        if (k == no_thing) continue;
        const CellKey cell = all.cells[k];
        for (; k < all.cells.size() && all.cells[k] == cell; ++k) {
          const SurfacePatch& other = all.patches[k];
          points += other.count;
          if (other.normal.dot(own.normal) >= same_plane &&
              std::abs(own.normal.cast<double>().dot(other.centre - own.centre)) <=
                  same_layer * all.lattice.size)
            agreeing += other.count;
        }
      }
  return agreeing >= least_share * points;
}

}  // namespace

SurfacePatches surface_patches(const Cloud& cloud, double cell_size) {
  SurfacePatches result;
  result.lattice = lattice_around(cloud.points, cell_size);
  std::vector<CellKey> cells = cell_keys(result.lattice, cloud.points);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cloud.normals[i].isZero()) cells[i] = no_cell;
  CellSort sorted = sort_by_cell(cells);
  const std::size_t blocks = sorted.blocks.size();
  std::vector<PatchList> lists((blocks + blocks_per_task - 1) / blocks_per_task);
  result.begin.assign(blocks + 1, 0);
  parallel_for(blocks, blocks_per_task, [&](std::size_t begin, std::size_t end) {
    PatchList& list = lists[begin / blocks_per_task];
    for (std::size_t b = begin; b < end; ++b) {
      for (std::uint32_t k = sorted.begin[b]; k < sorted.begin[b + 1];) {
        const CellKey cell = cells[sorted.order[k]];
        std::array<PatchSum, most_patches> sums;
        std::size_t used = 0;
        Occupancy occupied = 0;
        for (; k < sorted.begin[b + 1] && cells[sorted.order[k]] == cell; ++k) {
          const std::uint32_t i = sorted.order[k];
          const Eigen::Vector3d point = cloud.points[i].cast<double>() - result.lattice.origin;
          add_point(point, cloud.normals[i], sums, used);
          occupied |= part_of(point / cell_size);
        }
        add_patches(sums, used, cell, occupied, list);
      }
      result.begin[b + 1] = std::uint32_t(list.patches.size());
    }
  });
  std::uint32_t total = 0;
  for (std::size_t task = 0; task < lists.size(); ++task) {
    const std::size_t last = std::min(blocks, (task + 1) * blocks_per_task);
    for (std::size_t b = task * blocks_per_task; b < last; ++b) result.begin[b + 1] += total;
    total += std::uint32_t(lists[task].patches.size());
  }
  result.patches.reserve(total);
  result.cells.reserve(total);
  result.occupied.reserve(total);
  for (PatchList& list : lists) {
    result.patches.insert(result.patches.end(), list.patches.begin(), list.patches.end());
    result.cells.insert(result.cells.end(), list.cells.begin(), list.cells.end());
    result.occupied.insert(result.occupied.end(), list.occupied.begin(), list.occupied.end());
  }
  result.blocks = std::move(sorted.blocks);
  return result;
}

SurfacePatches selected(const SurfacePatches& patches, std::span<const std::uint32_t> positions) {
  SurfacePatches result;
  result.lattice = patches.lattice;
  std::vector<CellKey> blocks;
  for (const std::uint32_t k : positions) {
    const CellKey block = block_of(patches.cells[k]);
    if (blocks.empty() || blocks.back() != block) {
      blocks.push_back(block);
      result.begin.push_back(std::uint32_t(result.patches.size()));
    }
    result.patches.push_back(patches.patches[k]);
    result.cells.push_back(patches.cells[k]);
    result.occupied.push_back(patches.occupied[k]);
  }
  result.begin.push_back(std::uint32_t(result.patches.size()));
  result.blocks = BlockSet(std::move(blocks));
  return result;
}

SurfacePatches without_strays(const SurfacePatches& patches) {
  std::vector<std::uint8_t> kept(patches.patches.size());
  parallel_for(patches.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> first;
    for (std::size_t b = begin; b < end; ++b) {
      const CellKey block = patches.blocks.key(b);
      surrounding_cells(patches.blocks, patches.begin, patches.cells, block, 1, first);
      for (std::uint32_t k = patches.begin[b]; k < patches.begin[b + 1]; ++k)
        kept[k] = has_support(patches, k, cell_of(patches.cells[k]) - cell_of(block), first);
    }
  });
  std::vector<std::uint32_t> positions;
  for (std::uint32_t k = 0; k < kept.size(); ++k)
    if (kept[k]) positions.push_back(k);
  return selected(patches, positions);
}

}  // namespace planum
