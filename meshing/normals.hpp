#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/progress.hpp"

namespace planum {

/// How normals are estimated.
struct NormalParams {
  double cell = 0.05;  ///< m, planes are fitted to the points in 3 x 3 x 3 cells of this size
  int levels = 4;  ///< where that is too few points, or a line of them, cells double, up to cell *
                   ///< 2^(levels - 1)
  int min_points = 8;          ///< fewer points are no plane
  double min_width = 0.3;      ///< of a neighbourhood against its length (standard deviations);
                               ///< narrower ones are lines
  double max_scatter = 0.03;   ///< m, standard deviation of the points across a plane
  double max_thickness = 0.4;  ///< of a neighbourhood against its width; thicker ones are no planes
};

/// Unit normals of the points, towards the scanner that saw them; zero where there is no surface to
/// be found (stray points).
///
/// Least-squares planes over neighbourhoods that grow until they are well-formed, averaged over
/// overlapping neighbourhoods (Wiemann, Nuechter, Lingemann, Hertzberg 2010, section III-A); the
/// neighbourhoods are those of a voxel grid, so that the time is linear in the points. Points whose
/// scanner is behind a plane have no part in it: both sides of a thin wall stay apart. Of several
/// planes that a point may belong to, the thinner one counts more: creases stay sharp.
///
/// `cloud.scan` says which of `scan_origins` saw a point; it may be empty if there is one origin.
/// Throws Error if a point is not finite, or has no origin.
std::vector<Eigen::Vector3f> estimate_normals(const Cloud& cloud,
                                              std::span<const Eigen::Vector3d> scan_origins,
                                              const NormalParams& params = {},
                                              const Progress& progress = {});

}  // namespace planum
