#pragma once

#include "meshing/surface_patches.hpp"

namespace planum {

/// Adds patches where scan lines are so far apart that cells between them are empty: an empty cell
/// gets one where the patches of one sheet within `reach` cells lie on all sides of it, and cells
/// around are as sparsely filled everywhere (or else it is but one cell wide). An opening in a
/// densely sampled wall stays open, and no border grows outwards.
SurfacePatches with_gaps_filled(SurfacePatches patches, double reach);

}  // namespace planum
