#pragma once

#include <cstddef>
#include <string>

#include "slam/core/cloud.hpp"

namespace planum {

/// Throws Error, beginning with `step`, unless every point says which of so many scan origins saw
/// it; with one origin at most it need not say.
void check_scan_indices(const Cloud& cloud, std::size_t scan_origins, const std::string& step);

}  // namespace planum
