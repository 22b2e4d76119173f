#pragma once

#include <filesystem>

#include "labeling/occupancy.hpp"

namespace planum {

/// Writes PATH (.yaml) and, beside it, the same name with .pgm, for map_server of ROS: trinary, yaw
/// 0, free 254, occupied 0, unknown 205, which `free_thresh` 0.196 keeps unknown. Throws Error if a
/// file cannot be written, or if the grid has no cells.
void write_occupancy_map(const std::filesystem::path& path, const OccupancyGrid& map);

}  // namespace planum
