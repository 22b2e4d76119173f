#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

namespace planum {

/// How the direction of floors and ceilings is looked for.
struct UpParams {
  double max_tilt = 0.7853981633974483;  ///< rad, farthest from the prior
  double spread = 0.0523598775598299;  ///< rad, directions this near to each other are of one plane
  double min_share = 0.02;             ///< of all weight that must be on floors and ceilings
};

/// Which way is up, and how sure that is.
struct UpDirection {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit
  double share = 0;       ///< of all weight, what lies on floors and ceilings
  double confidence = 0;  ///< 0 to 1: floors and ceilings, and walls at right angles to them,
                          ///< against all weight, and against the best other direction
};

/// The common direction of floors and ceilings: of all directions near the prior (e.g. the z axis
/// of the scanner) the one that most weight is parallel to, counting also what stands upright on
/// it, so that a roof is not taken for a floor. Normals may point up or down; zero ones do not
/// count.
///
/// `weights` is empty (all equal) or as long as `normals`. Empty where too little is horizontal.
/// Throws Error if the lengths differ or the prior is zero.
std::optional<UpDirection> estimate_up(std::span<const Eigen::Vector3f> normals,
                                       std::span<const float> weights, const Eigen::Vector3d& prior,
                                       const UpParams& params = {});

}  // namespace planum
