#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "meshing/voxel_blocks.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// The mean of the tangent planes of some neighbouring points that face the same way.
struct SurfacePatch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, mean of the points
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit
  float count = 0;                                   ///< points
};

/// Which of the 4 x 4 x 4 parts of a cell hold points: bit x + 4 y + 16 z.
using Occupancy = std::uint64_t;
inline constexpr int parts_of_cell = 4;

/// Patches sorted by cell.
struct SurfacePatches {
  Lattice lattice;
  BlockSet blocks;
  std::vector<std::uint32_t> begin;  ///< per block its first patch, and the end
  std::vector<CellKey> cells;        ///< per patch
  std::vector<SurfacePatch> patches;
  std::vector<Occupancy> occupied;  ///< per patch, of its whole cell
};

/// One to four patches for each cell that has points with normals.
SurfacePatches surface_patches(const Cloud& cloud, double cell);

/// Leaves out patches that hardly any of the points around agree with, such as those of stray
/// normals at edges.
SurfacePatches without_strays(const SurfacePatches& patches);

/// The patches at these positions, which must not leave the order of cells.
SurfacePatches selected(const SurfacePatches& patches, std::span<const std::uint32_t> positions);

}  // namespace planum
