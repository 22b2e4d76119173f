#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "slam/core/plane.hpp"

namespace planum {

/// Where planes meet near a point.
struct PlaneMeeting {
  Eigen::Vector3d point;  ///< m
  int rank = 0;           ///< 1: moved along a normal, 2: onto a line, 3: onto the common point
};

/// The point nearest to `start` that lies in all planes, by least squares. Directions that the
/// planes hardly fix, because they are nearly parallel, are left as they are. Empty if the point is
/// off a plane by more than max_offset or off `start` by more than max_move (m).
std::optional<PlaneMeeting> meeting(std::span<const Plane> planes, const Eigen::Vector3d& start,
                                    double max_move, double max_offset);

/// Whether the angle between two planes is large enough for meeting() to find their line.
bool meet_in_a_line(const Plane& a, const Plane& b);

}  // namespace planum
