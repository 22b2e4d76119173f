#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/trajectory.hpp"
#include "slam/evaluation/error_statistics.hpp"

namespace planum {

/// The true pose of one scan in the frame of another.
struct Relation {
  double from = 0, to = 0;  ///< stamps
  Pose from_from_to = Pose::Identity();
};

struct RelationParams {
  double max_distance = 0;  ///< m, between true positions; 0: relations of poses in a row only
  std::size_t max_count = 100'000;  ///< of many, so many are evenly chosen; 0: all
};

/// Relations of a true trajectory. Throws Error if a pose is not finite or a parameter is out of
/// range.
std::vector<Relation> relations_of(const Trajectory& truth, const RelationParams& params = {});

/// How far the relations of a trajectory are from the true ones; translations in m, rotations in
/// degrees.
struct RelationError {
  ErrorStatistics translation, rotation;
  ErrorStatistics squared_translation, squared_rotation;  ///< m^2, degrees^2
  std::size_t unknown = 0;  ///< relations of poses that the trajectory does not have
};

/// The error of relations (Kuemmerle et al., On measuring the accuracy of SLAM algorithms,
/// Autonomous Robots 2009): no global frame, so no alignment, and an error counts once where it
/// happens. Throws Error if no relation has both of its poses in the trajectory, or something is
/// not finite.
RelationError relation_error(const Trajectory& estimate, std::span<const Relation> relations,
                             double max_stamp_difference = 0.01);

}  // namespace planum
