#pragma once

#include <filesystem>

#include "slam/core/cloud.hpp"

namespace planum {

/// Reads lines `x y z` in metres. The fourth of four (`x y z intensity`) or seven (`x y z intensity
/// r g b`) columns is the intensity; other columns are passed over. Points may be nan or inf.
/// Throws Error `path:line` for other lines, and if there is no point.
Cloud read_xyz(const std::filesystem::path& path);

/// Writes points, and intensities if there are any.
void write_xyz(const std::filesystem::path& path, const Cloud& cloud);

}  // namespace planum
