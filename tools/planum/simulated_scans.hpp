#pragma once

#include <filesystem>
#include <span>

#include "slam/core/progress.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/simulator.hpp"

namespace planum {

/// Scans a model from the poses and writes scanNNN.slices to a directory, which is made if need be.
/// Scans that are there already stay as they are.
void write_simulated_scans(const std::filesystem::path& directory, const TriangleMesh& model,
                           std::span<const Pose> model_from_scan, const SimulatorParams& params,
                           const Progress& progress = {});

/// Writes truth.tum, the poses relative to the first one, and odometry.tum, the same as odometry
/// with drift has it. Files that are there already stay as they are.
void write_simulated_trajectories(const std::filesystem::path& directory,
                                  std::span<const Pose> model_from_scan, const DriftParams& drift);

}  // namespace planum
