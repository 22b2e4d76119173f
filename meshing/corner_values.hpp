#pragma once

#include <span>

#include <Eigen/Core>

#include "meshing/surface_patches.hpp"

namespace planum {

/// How far (cells along each axis) patches may be from a corner to matter for it.
inline constexpr int patch_reach = 2;

/// Signed distances to the surface at the corners of one block, in cells, and the directions in
/// which they grow; not a number where no patch is within reach. Both spans hold block_cells.
///
/// At each corner the patches around belong to up to three sheets: the first is that of the nearest
/// patch, and so on. The distance to a sheet is the mean of its patches' planes, weighted by points
/// and by nearness along the sheet (zero at `radius` cells). Sheets that meet are joined as the
/// solids behind them: the smaller distance counts where both have the other in front of them, the
/// larger one where both have it behind them.
void corner_values(const SurfacePatches& patches, CellKey block, float radius,
                   std::span<float> distance, std::span<Eigen::Vector3f> normal);

}  // namespace planum
