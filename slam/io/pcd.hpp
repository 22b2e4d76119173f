#pragma once

#include <filesystem>

#include "slam/core/cloud.hpp"

namespace planum {

/// Writes a PCD file of version 0.7 for PCL and its tools: binary, float x y z, normal_x normal_y
/// normal_z, intensity and unsigned scan where the cloud has them. Throws Error if an attribute is
/// neither empty nor as long as the points.
void write_pcd(const std::filesystem::path& path, const Cloud& cloud);

}  // namespace planum
