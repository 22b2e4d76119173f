#pragma once

#include <string>

#include "slam/registration/icp.hpp"

namespace planum {

/// Why a match is not to be believed, whatever was expected of it: too few pairs, less overlap than
/// `min_overlap`, no convergence. Empty if nothing speaks against it.
std::string doubt_of_match(const Alignment& alignment, double min_overlap);

/// The same if rays of one scan go through more than `most` of the surfaces of the other; see
/// FreeSpaceCheck::contradicted.
std::string doubt_of_rays(double contradicted, double most);

}  // namespace planum
