#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshing/normals.hpp"
#include "meshing/voxel_blocks.hpp"

namespace planum {

/// The points of one cell that are seen from one side.
struct ViewPatch {
  /// Sums over the points, relative to the lattice's origin: 1, x, y, z, xx, xy, xz, yy, yz, zz.
  std::array<double, 10> moments{};
  Eigen::Vector3f view = Eigen::Vector3f::Zero();  ///< sum of unit vectors to the scanners
  std::uint64_t scans = 0;                         ///< bit (scan modulo 64) of each scan in it
};

/// The plane through the points around a patch.
struct PatchPlane {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< towards the scanners; zero: no plane
  float offset = 0;                                  ///< m, relative to the lattice's origin
  float variance = 0;                                ///< m^2, across the plane
  float weight = 0;                                  ///< inverse variance of the normal's direction
};

/// All patches of a cloud for one size of cells, sorted by cell.
struct PatchGrid {
  Lattice lattice;
  BlockSet blocks;
  std::vector<std::uint32_t> begin;  ///< per block its first patch, and the end
  std::vector<CellKey> cells;        ///< per patch
  std::vector<ViewPatch> patches;
};

/// Calls visit(patch) for the patches of the 3 x 3 x 3 cells around one. `first` is what
/// surrounding_cells() found for the block, one cell deep; `at` is the cell's place in the block.
template <class Visit>
void for_patches_around(const PatchGrid& grid, const std::vector<std::uint32_t>& first,
                        const Eigen::Vector3i& at, const Visit& visit) {
  constexpr int width = block_width + 2;
  for (int z = at.z(); z < at.z() + 3; ++z)
    for (int y = at.y(); y < at.y() + 3; ++y)
      for (int x = at.x(); x < at.x() + 3; ++x) {
        std::uint32_t patch = first[std::size_t((z * width + y) * width + x)];
        if (patch == no_thing) continue;
        const CellKey cell = grid.cells[patch];
        for (; patch < grid.cells.size() && grid.cells[patch] == cell; ++patch) visit(patch);
      }
}

/// One patch a cell, two where scanners look at its points from opposite sides.
PatchGrid view_patches(const Lattice& lattice, const CellSort& sorted,
                       std::span<const CellKey> cells, const Cloud& cloud,
                       std::span<const Eigen::Vector3d> scan_origins);

/// The same with cells of twice the size.
PatchGrid coarser(const PatchGrid& fine);

/// For each patch the plane of the 3 x 3 x 3 cells around it, without patches whose scanners are
/// behind that plane.
std::vector<PatchPlane> patch_planes(const PatchGrid& grid, const NormalParams& params);

}  // namespace planum
