#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

struct RangeViewParams {
  double bin = radians(1.5);   ///< rad, edge of the bins of directions
  double cone = radians(1.0);  ///< rad, a return counts for all directions so near to its own ...
  double spread = 0.05;        ///< m, ... and so near to it sideways
  double margin = 0.06;        ///< m, what lies less behind a surface than this touches it
  double max_tilt = radians(80);  ///< rad, rays that meet a surface flatter than this say nothing
  std::size_t samples = 3000;     ///< points that are looked at from elsewhere; 0: all
};

/// What a scan sees in each direction: between which ranges all of its returns near it lie.
struct RangeView {
  struct Sample {
    Eigen::Vector3f point;   ///< m
    Eigen::Vector3f normal;  ///< unit
  };

  RangeViewParams params;
  double noise = 0;             ///< m, of the scan
  std::vector<Sample> samples;  ///< of its surfaces, in the scanner's frame
  std::size_t columns = 0;     ///< bins of a turn; as many for each of the rows from below to above
  std::vector<float> nearest;  ///< m, row by row; 0: no return there
  std::vector<float> farthest;  ///< m
};

/// Throws Error if a parameter is out of range.
RangeView range_view(const MatchingScan& scan, const RangeViewParams& params = {});

/// Of many scans at once, with the parameters as they are.
std::vector<RangeView> range_views(std::span<const MatchingScan> scans);

/// How the surfaces of one scan look from the scanner of another.
struct Visibility {
  std::size_t contradictions = 0;  ///< the other scan's rays go on behind them
  std::size_t agreements = 0;      ///< the other scan has returns there
  std::size_t occluded = 0;        ///< the other scan's rays end before them
  std::size_t unseen = 0;          ///< no rays there, or too flat ones

  /// The share of contradictions among the surfaces that the other scan's rays came to; 0 if none.
  double contradicted() const;
};

/// How the surfaces of `source` look from the scanner of `target`.
Visibility visibility(const RangeView& source, const RangeView& target,
                      const Pose& target_from_source);

/// Both ways: rays of one scan do not pass through surfaces of the other at the right pose, but for
/// what moved in between.
struct FreeSpaceCheck {
  Visibility source_from_target;  ///< surfaces of the source, seen by the target
  Visibility target_from_source;  ///< surfaces of the target, seen by the source

  /// The worse of both ways, of those where `least_seen` samples were come to; 0 if neither.
  double contradicted(std::size_t least_seen = 50) const;
};

/// More than this much contradicted is a wrong pose: people and doors that moved make less.
inline constexpr double most_contradicted = 0.05;

FreeSpaceCheck check_free_space(const RangeView& source, const RangeView& target,
                                const Pose& target_from_source);

}  // namespace planum
