#pragma once

#include "slam/core/trajectory.hpp"
#include "tools/report/run_report.hpp"
#include "tools/workflow/results.hpp"

namespace planum {

/// The scans of the map, stamped with their numbers.
Trajectory mapped_trajectory(const Imported& imported, const World& world);

/// All scans where their poses had them.
Trajectory odometry_trajectory(const Imported& imported, const World& world);

/// Errors of the poses whose stamps are in the truth, after alignment (docs/evaluation.md).
TrajectoryFigures trajectory_figures(const Trajectory& estimate, const Trajectory& truth);

/// The rigid motion that brings the positions of the estimate onto those of the truth.
Pose truth_from_estimate(const Trajectory& estimate, const Trajectory& truth);

}  // namespace planum
