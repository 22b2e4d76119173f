#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/graph/lu_milios_system.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

using ScanPair = std::pair<std::size_t, std::size_t>;  ///< numbers of two scans, ascending

struct OverlapChoice {
  double max_distance = 15;        ///< m, scans taken farther apart are not considered
  double min_overlap = 0.15;       ///< estimated share of common points
  std::size_t links_per_scan = 8;  ///< each scan brings its best ones
};

/// Pairs of scans that see the same surfaces if the poses are right, ascending.
std::vector<ScanPair> overlapping_scans(std::span<const MatchingScan> scans,
                                        const std::vector<Pose>& world_from_scan,
                                        const OverlapChoice& choice,
                                        const std::set<ScanPair>& excluded = {});

/// What the pairs of a link say with some poses.
struct LinkFit {
  LinkEquation equation;
  double squared_residuals = 0;  ///< m^2, weighted sum
  double weight = 0;
  std::size_t pairs = 0;
  double overlap = 0;  ///< share of the points looked at that have a pair

  double rms() const;  ///< m
};

/// Two scans whose points are paired both ways, again and again while they move. Points of scan a
/// find theirs in b, and those of b in a, so that neither is favoured.
class ScanLink {
 public:
  /// `selections`: for each scan the positions of the points that are looked at.
  ScanLink(const ScanPair& pair, std::span<const MatchingScan> scans,
           std::span<const std::vector<std::uint32_t>> selections);

  /// The residuals of all pairs, linearized for motions X <- exp_se3(x) X of both poses, weighted
  /// by the inverse of their variance. Fewer than min_pairs one way say nothing that way.
  LinkFit fit(const std::vector<Pose>& world_from_scan, Pairing pairing, double gate,
              double max_normal_angle, std::size_t min_pairs);

  /// Looks at other points from now on, positions for each scan as above.
  void select(std::span<const std::vector<std::uint32_t>> selections);

  const ScanPair& pair() const { return pair_; }

  /// m, of a residual between the two scans.
  double noise() const { return noise_; }

 private:
  ScanPair pair_;
  double noise_, spacing_;
  PairFinder a_in_b_, b_in_a_;
};

}  // namespace planum
