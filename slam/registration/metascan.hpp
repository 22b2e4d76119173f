#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

struct MetascanParams {
  std::size_t scans = 5;      ///< that are put together, at most
  double max_distance = 15;   ///< m, scans taken farther apart are left out
  double min_overlap = 0.05;  ///< estimated, of the new scan with each of them
};

/// Which of the scans before a new one are to be matched with it at once: those that seem to
/// overlap it most, ascending. `earlier` are their poses (world_from_scan); the new scan is
/// scans[earlier.size()], and `guess` has it in the frame of the last earlier one.
std::vector<std::size_t> metascan_members(std::span<const MatchingScan> scans,
                                          std::span<const Pose> earlier, const Pose& guess,
                                          const MetascanParams& params = {});

/// Some scans as one, in the frame of the last earlier one. Normals still face the scanner that
/// measured them.
MatchingScan metascan_of(std::span<const MatchingScan> scans, std::span<const Pose> earlier,
                         std::span<const std::size_t> members);

}  // namespace planum
