#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

/// A pair of scans that may be a loop, and how well the path between them is known.
struct LoopCandidate {
  std::size_t from = 0, to = 0;
  Pose guess = Pose::Identity();  ///< from_from_to, as the path has it
  std::optional<Pose> start{};    ///< where the match begins, if not at the guess
  Matrix6d covariance = Matrix6d::Zero();
  double overlap = 0;  ///< estimated share of common points

  /// m, the first gate of a match: some standard deviations of the guess.
  double gate(const LoopParams& params) const;
};

/// m, standard deviation of where a pose with this covariance puts a point so far away.
double placed_within(const Matrix6d& covariance, double radius);

/// What a step of the path may be off beyond its covariance.
Matrix6d step_noise(const LoopParams& params);

/// Covariance of what may be anywhere within the widest gate.
Matrix6d unknown_pose(const LoopParams& params);

/// Whether a pair of scans is to be tried (again) from its guess; the overlap is not known yet.
using WorthATry = std::function<bool(const LoopCandidate&)>;

/// Pairs that are near each other and seem to overlap but are not placed well by the path, most
/// overlapping first: of each scan at most `per_scan`; a pair counts for both of its scans.
std::vector<LoopCandidate> loop_candidates(std::span<const MatchingScan> scans,
                                           const PoseGraph& graph, const WorthATry& worth_a_try,
                                           std::size_t per_scan, const LoopParams& params);

/// Pairs that look alike (find_places) and that the path leaves open by more than the widest gate;
/// their matches begin at the pose that the likeness gives. Scans are not compared if the path is
/// surer of all pairs.
std::vector<LoopCandidate> candidates_by_appearance(std::span<const MatchingScan> scans,
                                                    const PoseGraph& graph,
                                                    const LoopParams& params,
                                                    const Progress& progress);

}  // namespace planum
