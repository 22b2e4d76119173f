#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/pair_matchers.hpp"
#include "slam/registration/see_through.hpp"

namespace planum {

struct LoopParams {
  double max_distance = 10;   ///< m, scans taken farther apart are no candidates
  double min_overlap = 0.25;  ///< share of common points, first estimated, then that of the match
  double known_within = 0.1;  ///< m, pairs whose points the path places better than this (standard
                              ///< deviation) are no candidates: the relaxation links them anyway
  std::size_t candidates_per_scan = 4;  ///< each scan brings its most overlapping ones
  /// What a step of the path may be off beyond its covariance (scans are bent, floors are not
  /// flat).
  double step_translation = 0.02;        ///< m
  double step_rotation = radians(0.25);  ///< rad
  double max_deviation = 4;    ///< standard deviations a match may be off from what the path has
  double max_rms_ratio = 2.5;  ///< rms of a match, in median rms of the steps of the path
  double max_contradicted = most_contradicted;  ///< share of the surfaces of one scan that rays of
                                                ///< the other go through
  double least_gate = 0.3;    ///< m, first gate of a match however sure the path is
  double most_gate = 3.0;     ///< m, the same however unsure
  bool by_appearance = true;  ///< also pairs that look alike, where the path leaves more open than
                              ///< most_gate
  int max_rounds = 5;         ///< of looking for candidates with the loops so far closed
};

/// Looks for scans that were taken near each other but not one after another: candidates by
/// distance and overlap, given how uncertain the path between them is; each one verified by its
/// match (verified_loop) and by the other loops (consistent_loops, and all together). Returns all
/// that were tried; those not accepted say why. Throws Error if the graph and the scans do not go
/// together or a parameter is out of range.
std::vector<Edge> find_loops(std::span<const MatchingScan> scans, const PoseGraph& graph,
                             const GatedPairMatcher& matcher, const LoopParams& params = {},
                             const Progress& progress = {});

}  // namespace planum
