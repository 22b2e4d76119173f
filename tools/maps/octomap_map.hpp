#pragma once

#include <filesystem>
#include <span>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"

namespace planum {

struct OctomapParams {
  double cell = 0.05;  ///< m, edge of the smallest cells
};

/// Writes PATH (.bt, each cell free or occupied, whichever is more likely) and, beside it, the same
/// name with .ot (log odds). It is the tree that OctoMap's `insertPointCloud` makes of the scans
/// one after another, discretized: in each scan cells with points are occupied, cells that its rays
/// pass are free. `cloud` has a `scan` index into `scan_origins` (which may be missing if there is
/// one).
/// Throws Error if there are no points or origins, if something is farther from 0 than 2^15 cells,
/// for a cell that is none, and if a file cannot be written. The same for any number of threads.
void write_octomap(const std::filesystem::path& path, const Cloud& cloud,
                   std::span<const Eigen::Vector3d> scan_origins, const OctomapParams& params = {});

}  // namespace planum
