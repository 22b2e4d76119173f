#pragma once

#include <vector>

#include "tools/workflow/project_keys.hpp"

/// A place in Settings as a function, e.g. FIELD(double, icp.first_gate).
#define FIELD(Type, member) +[](Settings& s) -> Type& { return s.member; }

/// The keys of the project file, in the order of its tables.
namespace planum {

std::vector<Key> scan_keys();     ///< where scans are and how they are read
std::vector<Key> slam_keys();     ///< how scans are brought together
std::vector<Key> surface_keys();  ///< from the cloud to polygons
std::vector<Key> label_keys();    ///< what polygons are, rooms
std::vector<Key> map_keys();      ///< what comes out

}  // namespace planum
