#pragma once

#include "meshing/polygon_drafts.hpp"

namespace planum {

/// Changes which vertices simplified borders keep until no polygon crosses itself, or no change
/// helps: vertices of the small loop behind a crossing are dropped; borders that cross elsewhere
/// are simplified less. Returns how many polygons are still not valid.
std::size_t uncross_borders(BorderNetwork& network, const DraftParams& params, double max_error);

}  // namespace planum
