#pragma once

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/pose.hpp"

namespace planum {

struct LevelParams {
  double max_tilt = radians(3);  ///< between the normal of a point on a floor or ceiling and up
  double band = 0.05;            ///< m, above and below the height of a floor, where its points are
  double min_share = 0.05;       ///< of the points of the largest floor; smaller ones do not count
  double prior_error = radians(0.2);  ///< how wrong `up` may be where the floors do not say
};

/// Up, to the accuracy that the planes of floors and ceilings allow: the direction from which the
/// points of each of them lie at one height, by least squares with Tukey's weights. A direction
/// that comes from normals alone, such as that of estimate_up(), carries the errors of their
/// neighbourhoods. Where the floors do not say (a narrow one about its long axis), `up` stays.
/// Throws Error if the cloud has no normals or `up` is zero.
Eigen::Vector3d up_of_planes(const Cloud& cloud, const Eigen::Vector3d& up,
                             const LevelParams& params = {});

}  // namespace planum
