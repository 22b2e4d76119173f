#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/pair_matchers.hpp"
#include "slam/registration/see_through.hpp"

namespace planum {

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
  bool odometry_known = true;     ///< false: guesses are mere beginnings, matches may end anywhere
  double second_gate = 2.5;       ///< m, first gate of the second attempt at a step
  double second_min_overlap = 0.3;  ///< of a match of a second or later attempt, which is made
                                    ///< where the first has less, too
  double max_contradicted = most_contradicted;  ///< share of the surfaces of one scan that rays of
                                                ///< the other go through
  OdometryNoise odometry = {};
};

/// What else a sequence can do for a step whose match cannot be trusted or has little overlap, one
/// after another; those not given are left out.
struct SequenceAids {
  GatedPairMatcher second;   ///< with a wide gate
  MetascanMatcher metascan;  ///< with all earlier scans that overlap
  /// Where scan `source` lies in the frame of scan `target`, without a guess; empty if it is not
  /// sure.
  std::function<std::optional<Alignment>(std::size_t target, std::size_t source)> locate;
  /// The share of the surfaces of one scan that rays of the other go through.
  std::function<double(std::size_t target, std::size_t source, const Pose& target_from_source)>
      contradicted;
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
/// match that cannot be trusted is tried again with the aids, and at last replaced by odometry with
/// its honest, weak information; what a match leaves undetermined (weak directions) has the
/// information of odometry too.
/// Throws Error if a parameter is out of range or a pose is not finite.
SequenceMatch match_in_order(std::span<const Pose> odometry, const PairMatcher& matcher,
                             const SequenceParams& params = {}, const Progress& progress = {},
                             const SequenceAids& aids = {});

/// The same against a growing metascan: each scan is matched with all earlier ones that overlap it.
SequenceMatch match_to_metascan(std::span<const Pose> odometry, const MetascanMatcher& matcher,
                                const SequenceParams& params = {}, const Progress& progress = {},
                                const SequenceAids& aids = {});

}  // namespace planum
