#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

/// Matches scan `source` with scan `target`, both numbers in a list. Whoever calls matching
/// functions may put one that remembers its results on disk in place of icp_matcher().
using PairMatcher =
    std::function<Alignment(std::size_t target, std::size_t source, const Pose& guess)>;

/// Matches by align(); the scans must outlive it. Errors say which scans.
PairMatcher icp_matcher(std::span<const MatchingScan> scans, const IcpParams& params = {});

/// How far odometry is off, standard deviations of a motion between two stops: a floor, and what
/// grows with the way.
struct OdometryNoise {
  double translation = 0.05;               ///< m
  double translation_per_metre = 0.1;      ///< m/m
  double rotation = radians(2);            ///< rad
  double rotation_per_radian = 0.1;        ///< rad/rad
  double rotation_per_metre = radians(2);  ///< rad/m
};

/// What odometry knows about a motion, in the sense of Alignment::information.
Matrix6d odometry_information(const Pose& motion, const OdometryNoise& noise = {});

struct SequenceParams {
  double min_overlap = 0.15;      ///< of a match that counts
  double max_shift = 2.0;         ///< m, a match farther from its guess has gone astray
  double max_turn = radians(45);  ///< rad, the same
  OdometryNoise odometry = {};
};

/// The step from a scan to the next one.
struct SequenceStep {
  Alignment alignment;  ///< target: the earlier scan. As odometry has it where not matched
  Matrix6d odometry_information = Matrix6d::Zero();  ///< part of the alignment's
  bool matched = false;
  std::string reason{};  ///< why not matched, e.g. "overlap 0.08 is below 0.15"
};

/// Poses of scans one after another.
struct SequenceMatch {
  std::vector<Pose> poses;          ///< world_from_scan; the first one is that of odometry
  std::vector<SequenceStep> steps;  ///< step i goes from scan i to scan i + 1
};

/// Matches each scan with the one before it, starting from odometry moved by the last correction. A
/// match that cannot be trusted is replaced by odometry with its honest, weak information; what a
/// match leaves undetermined (weak directions) has the information of odometry too.
/// Throws Error if a parameter is out of range or a pose is not finite.
SequenceMatch match_in_order(std::span<const Pose> odometry, const PairMatcher& matcher,
                             const SequenceParams& params = {}, const Progress& progress = {});

}  // namespace planum
