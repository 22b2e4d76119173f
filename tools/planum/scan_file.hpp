#pragma once

#include <filesystem>
#include <optional>

#include "slam/core/cloud.hpp"

namespace planum {

/// Points of a file of any format, told by its ending; a slices file becomes points in the frame of
/// the scanner, without limits of range. Empty if the ending is none of points.
std::optional<Cloud> read_points_file(const std::filesystem::path& file);

}  // namespace planum
