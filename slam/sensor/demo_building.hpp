#pragma once

#include <vector>

#include "slam/core/pose.hpp"
#include "slam/sensor/building.hpp"

namespace planum {

/// The building of the program's demonstration: six furnished rooms round a corridor that is itself
/// a ring round a core, 15 m x 12 m inside, with ten doors and twelve windows.
BuildingPlan demo_plan();
Building demo_building();

/// Where a robot stops to scan in it: through the rooms once round the core, back to the start, and
/// on along the corridor. Stops are at most 2.5 m and 40 degrees apart; one stands in or
/// just before each door.
std::vector<Pose> demo_poses();

}  // namespace planum
