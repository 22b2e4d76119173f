#pragma once

#include <cstddef>
#include <vector>

#include "slam/core/trajectory.hpp"
#include "slam/evaluation/error_statistics.hpp"

namespace planum {

struct SegmentErrorParams {
  /// m, of segments along the true path; empty: 1, 2 and 5 times powers of ten between the median
  /// step and the whole path.
  std::vector<double> lengths{};
  std::size_t stride = 1;              ///< a segment of each length begins at every so many poses
  double max_stamp_difference = 0.01;  ///< as TrajectoryErrorParams has it
};

/// Errors of the segments of one length, per metre of their true path.
struct SegmentsOfLength {
  double length = 0;            ///< m, that was asked for
  double mean_path = 0;         ///< m, from the first to the last pose of a segment
  ErrorStatistics translation;  ///< m/m
  ErrorStatistics rotation;     ///< degrees/m
};

struct SegmentError {
  double path = 0;                        ///< m, the whole true path
  std::vector<SegmentsOfLength> lengths;  ///< those for which the path is long enough
  ErrorStatistics translation;            ///< m/m, over the segments of all lengths
  ErrorStatistics rotation;               ///< degrees/m
};

/// Drift per metre (Geiger, Lenz, Urtasun: KITTI, CVPR 2012): the relative error over segments of
/// the true path, from each pose to the first one that is at least a length away along it, divided
/// by the path between the two. Poses that belong together are taken in the order of the true
/// stamps. Throws Error as trajectory_error() does.
SegmentError segment_error(const Trajectory& estimate, const Trajectory& truth,
                           const SegmentErrorParams& params = {});

}  // namespace planum
