#pragma once

#include "slam/core/trajectory.hpp"
#include "slam/evaluation/segment_error.hpp"
#include "slam/evaluation/trajectory_error.hpp"
#include "tools/report/run_report.hpp"
#include "tools/workflow/results.hpp"

namespace planum {

/// The scans of the map, stamped with their numbers.
Trajectory mapped_trajectory(const Imported& imported, const World& world);

/// All scans where their poses had them.
Trajectory odometry_trajectory(const Imported& imported, const World& world);

/// The errors that a report names.
TrajectoryFigures trajectory_figures(const TrajectoryError& error, const SegmentError& segments);

}  // namespace planum
