#pragma once

#include <filesystem>

#include "slam/sensor/building.hpp"
#include "tools/planum/console.hpp"

namespace planum {

/// Writes the demonstration to a directory: building.obj, true_poses.txt, dimensions.json,
/// truth.tum, odometry.tum, scans/scanNNN.slices and project.toml. What is there already stays: the
/// same seed makes the same files.
void write_demo_case(const std::filesystem::path& directory, const Building& building,
                     Console& console);

}  // namespace planum
