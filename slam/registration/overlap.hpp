#pragma once

#include <cstddef>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

struct OverlapParams {
  double distance = 0.25;                 ///< m, points nearer than this may be of one surface
  double max_normal_angle = radians(45);  ///< rad, ... if it faces the same way
  std::size_t samples = 300;              ///< points of the source that are looked at
};

/// The share of the source's points that have the target's surface near them: what a match from
/// this pose could use at most, for a small part of its cost.
double estimated_overlap(const MatchingScan& source, const MatchingScan& target,
                         const Pose& target_from_source, const OverlapParams& params = {});

}  // namespace planum
