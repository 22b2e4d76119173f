#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/sensor/building.hpp"

namespace planum {

/// A building that nobody has looked at, and a path through it, for laws in tests.
struct RandomBuilding {
  Building building;
  std::vector<Pose> poses;  ///< model_from_scan, at most 2.5 m and 40 degrees from one to the next
};

/// Rooms of random sizes on both sides of a straight corridor, all turned by a random angle, with a
/// door, a window, and furniture each. The same for the same seed. Throws Error without rooms.
RandomBuilding random_building(std::uint64_t seed, std::size_t rooms = 4);

}  // namespace planum
