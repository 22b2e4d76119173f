#include "meshing/surface_gaps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 4;
constexpr int margin = 5;  ///< cells around a block that are looked at
constexpr int table_width = block_width + 2 * margin;
constexpr float same_direction = 0.7f;  // cosine, about 45 degrees
constexpr float same_layer = 0.6f;      // cells

/// A patch in coordinates of one block, in cells.
struct NearPatch {
  Eigen::Vector3f centre, normal;
};

/// The patches in and around one block.
class Surroundings {
 public:
  void read(const SurfacePatches& all, CellKey block) {
    all_ = &all;
    corner_ = cell_of(block);
    surrounding_cells(all.blocks, all.begin, all.cells, block, margin, first_);
  }

  /// Calls visit(patch) for the patches of cells within `reach` of a cell.
  template <class Visit>
  void around(const Eigen::Vector3i& cell, int reach, const Visit& visit) const {
    const Eigen::Vector3i low = (cell.array() - reach + margin).max(0);
    const Eigen::Vector3i high = (cell.array() + reach + margin).min(table_width - 1);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          std::uint32_t k = first_[std::size_t((z * table_width + y) * table_width + x)];
          if (k == no_thing) continue;
          const CellKey key = all_->cells[k];
          for (; k < all_->cells.size() && all_->cells[k] == key; ++k) visit(k);
        }
  }

  NearPatch local(std::uint32_t k) const {
    const SurfacePatch& patch = all_->patches[k];
    return {(patch.centre / all_->lattice.size - corner_.cast<double>()).cast<float>(),
            patch.normal};
  }

 private:
  const SurfacePatches* all_ = nullptr;
  Eigen::Vector3i corner_;
  std::vector<std::uint32_t> first_;
};

/// Two directions along a plane.
struct Tangents {
  Eigen::Vector3f first, second;
  explicit Tangents(const Eigen::Vector3f& normal)
      : first(normal.unitOrthogonal()), second(normal.cross(first)) {}
};

/// What the sheet through a place looks like from there.
struct Outlook {
  float weight = 0, distance = 0;  ///< of the averaged planes from the place, weighted
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  std::uint32_t sides = 0;       ///< bit d: a patch within reach in direction d of 16
  std::uint32_t near_sides = 0;  ///< the same, right beside the place
  std::uint64_t filled = 0;      ///< of 8 x 8 cells along the sheet those with a patch
};

void look(const Surroundings& patches, const Eigen::Vector3i& cell, const Eigen::Vector3f& at,
          const NearPatch& sheet, float reach, Outlook& outlook) {
  const Tangents tangents(sheet.normal);
  patches.around(cell, margin - 1, [&](std::uint32_t k) {
    const NearPatch patch = patches.local(k);
    const Eigen::Vector3f d = patch.centre - at;
    if (patch.normal.dot(sheet.normal) < same_direction ||
        std::abs(sheet.normal.dot(patch.centre - sheet.centre)) > same_layer + 0.2f * d.norm())
      return;
    const float x = tangents.first.dot(d), y = tangents.second.dot(d);
    if (std::abs(x) < 4 && std::abs(y) < 4)
      outlook.filled |= std::uint64_t{1} << (int(std::floor(x + 4)) + 8 * int(std::floor(y + 4)));
    const float along = std::sqrt(x * x + y * y);
    if (along > reach) return;
    const float kernel = 1 - along * along / (reach * reach) + 1e-3f;
    outlook.weight += kernel;
    outlook.distance -= kernel * patch.normal.dot(d);
    outlook.normal += kernel * patch.normal;
    const float turn = (std::atan2(y, x) / std::numbers::pi_v<float> + 1) * 8;
    const std::uint32_t side = 1u << (int(turn) & 15);
    outlook.sides |= side;
    if (along < 1.5f) outlook.near_sides |= side;
  });
}

/// Whether no two neighbouring directions are far apart.
bool on_all_sides(std::uint32_t sides) {
  constexpr int widest = 6;  // of 16 directions
  if (sides == 0) return false;
  const std::uint32_t twice = sides | sides << 16;
  int run = 0;
  for (int k = 0; k < 32; ++k) {
    run = (twice >> k & 1) != 0 ? 0 : run + 1;
    if (run > widest) return false;
  }
  return true;
}

/// Whether more than half of the cells around are empty.
bool sparse(const Outlook& outlook) { return std::popcount(outlook.filled) < 32; }

/// Per patch whether there may be gaps beside it.
std::vector<std::uint8_t> patches_at_gaps(const SurfacePatches& all) {
  constexpr int full = 9;  // the cells of a plane among 3 x 3 x 3
  std::vector<std::uint8_t> result(all.patches.size(), 0);
  parallel_for(all.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    Surroundings around;
    for (std::size_t b = begin; b < end; ++b) {
      around.read(all, all.blocks.key(b));
      for (std::uint32_t k = all.begin[b]; k < all.begin[b + 1]; ++k) {
        const Eigen::Vector3i cell = cell_of(all.cells[k]) - cell_of(all.blocks.key(b));
        int neighbours = 0;
        around.around(cell, 1, [&](std::uint32_t) { ++neighbours; });
        if (neighbours >= full) continue;
        Outlook outlook;
        const NearPatch patch = around.local(k);
        look(around, cell, patch.centre, patch, 1, outlook);
        result[k] = sparse(outlook);
      }
    }
  });
  return result;
}

/// Patches to be added, with their cells.
struct Filling {
  std::vector<SurfacePatch> patches;
  std::vector<CellKey> cells;
};

/// For each cell of a block the nearest of the patches at gaps whose plane runs through it.
std::array<std::uint32_t, block_cells> cells_on_planes(const Surroundings& around,
                                                       const std::vector<std::uint8_t>& at_gap) {
  constexpr int reach = 3;
  std::array<std::uint32_t, block_cells> offers;
  std::array<float, block_cells> nearest;
  offers.fill(no_thing);
  nearest.fill(std::numeric_limits<float>::infinity());
  const Eigen::Vector3i middle = Eigen::Vector3i::Constant(block_width / 2);
  around.around(middle, block_width / 2 + reach, [&](std::uint32_t k) {
    if (!at_gap[k]) return;
    const NearPatch patch = around.local(k);
    const float half = 0.5f * patch.normal.lpNorm<1>();
    const Eigen::Array3i cell = patch.centre.array().floor().cast<int>();
    const Eigen::Array3i low = (cell - reach).max(0), high = (cell + reach).min(block_width - 1);
    for (int z = low.z(); z <= high.z(); ++z)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int x = low.x(); x <= high.x(); ++x) {
          const Eigen::Vector3f d =
              Eigen::Vector3f(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f) - patch.centre;
          const auto c = std::size_t((z * block_width + y) * block_width + x);
          if (std::abs(patch.normal.dot(d)) > half || d.squaredNorm() >= nearest[c]) continue;
          nearest[c] = d.squaredNorm();
          offers[c] = k;
        }
  });
  return offers;
}

/// Adds a patch to an empty cell if there should be one on the sheet.
void fill_cell(const Surroundings& around, const Eigen::Vector3i& cell, const NearPatch& sheet,
               float reach, const SurfacePatches& all, CellKey block, Filling& filling) {
  bool empty = true;
  around.around(cell, 0, [&](std::uint32_t k) {
    empty = empty && around.local(k).normal.dot(sheet.normal) < same_direction;
  });
  if (!empty) return;
  const Eigen::Vector3f middle = cell.cast<float>().array() + 0.5f;
  const Eigen::Vector3f at = middle - sheet.normal.dot(middle - sheet.centre) * sheet.normal;
  Outlook outlook;
  look(around, cell, at, sheet, reach, outlook);
  if (!on_all_sides(outlook.near_sides) && !(on_all_sides(outlook.sides) && sparse(outlook)))
    return;
  const Eigen::Vector3f normal = outlook.normal.normalized();
  const Eigen::Vector3f centre = at - outlook.distance / outlook.weight * normal;
  if (((centre - middle).array().abs() > 0.5f).any()) return;
  constexpr float count = 0.5f;  // less than any patch with points
  const Eigen::Vector3i corner = cell_of(block);
  filling.patches.push_back(
      {.centre = (centre.cast<double>() + corner.cast<double>()) * all.lattice.size,
       .normal = normal,
       .count = count});
  filling.cells.push_back(
      cell_key(corner.x() + cell.x(), corner.y() + cell.y(), corner.z() + cell.z()));
}

/// The patches of both, in order.
SurfacePatches united(SurfacePatches patches, const std::vector<Filling>& fillings) {
  for (const Filling& filling : fillings) {
    patches.patches.insert(patches.patches.end(), filling.patches.begin(), filling.patches.end());
    patches.cells.insert(patches.cells.end(), filling.cells.begin(), filling.cells.end());
  }
  patches.occupied.resize(patches.patches.size(), ~Occupancy{0});
  return selected(patches, sort_by_cell(patches.cells).order);
}

}  // namespace

SurfacePatches with_gaps_filled(SurfacePatches patches, double reach) {
  if (!(reach > 0)) return patches;
  const std::vector<std::uint8_t> at_gap = patches_at_gaps(patches);
  std::vector<Filling> fillings((patches.blocks.size() + blocks_per_task - 1) / blocks_per_task);
  parallel_for(patches.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    Surroundings around;
    for (std::size_t b = begin; b < end; ++b) {
      const CellKey block = patches.blocks.key(b);
      around.read(patches, block);
      const auto offers = cells_on_planes(around, at_gap);
      for (int c = 0; c < block_cells; ++c) {
        if (offers[std::size_t(c)] == no_thing) continue;
        const Eigen::Vector3i cell(c % block_width, c / block_width % block_width,
                                   c / (block_width * block_width));
        fill_cell(around, cell, around.local(offers[std::size_t(c)]), float(reach), patches, block,
                  fillings[begin / blocks_per_task]);
      }
    }
  });
  return united(std::move(patches), fillings);
}

}  // namespace planum
