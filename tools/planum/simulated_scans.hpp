#pragma once

#include <filesystem>
#include <span>

#include "slam/core/progress.hpp"
#include "slam/sensor/odometry_drift.hpp"
#include "slam/sensor/simulator.hpp"

namespace planum {

/// Scans a model from the poses and writes scanNNN.slices, odometry.tum (drifting) and truth.tum to
/// a directory, which is made if need be. Both trajectories are relative to the first pose.
void write_simulated_scans(const std::filesystem::path& directory, const TriangleMesh& model,
                           std::span<const Pose> model_from_scan, const SimulatorParams& simulator,
                           const DriftParams& drift, const Progress& progress = {});

}  // namespace planum
