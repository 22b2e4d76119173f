#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "slam/core/cloud.hpp"

namespace planum {

/// Which measured ranges are used; the keys min_range_m and max_range_m of the project file.
struct RangeLimits {
  double min_range = 0.3;   ///< m, nearer is the robot itself or a reflex in the scanner's window
  double max_range = 30.0;  ///< m, farther is no return (UOS writes about 3276 cm); 0: no limit
  double max_not_finite = 0.5;  ///< share of a scan that may be NaN or infinite; 1: any
};

/// What became of every measured value; measured is the sum of all that follow it.
struct ImportCounts {
  std::size_t measured = 0;  ///< beams of a raw scan, or points of a file
  std::size_t no_return =
      0;  ///< beams with 0, a negative range, or one outside the sensor's limits
  std::size_t not_finite = 0;  ///< NaN or infinite
  std::size_t too_near = 0;    ///< below min_range
  std::size_t too_far = 0;     ///< above max_range
  std::size_t kept = 0;
};

/// The usable points of a scan.
struct ImportedScan {
  Cloud cloud;                        ///< in the scanner's frame
  std::vector<std::uint32_t> source;  ///< for each point: which beam or point of the input it was
  ImportCounts counts;
};

/// The points of a scan within the limits, seen from the origin of its frame, in their order.
/// Throws Error if the limits are not 0 <= min < max.
ImportedScan limited(const Cloud& scan, const RangeLimits& limits = {});

/// Throws Error, with the numbers and what to do, if a scan cannot be trusted: it was empty, more
/// than max_not_finite of it was not finite, or the limits leave nothing of it.
void check_import(const ImportCounts& counts, const RangeLimits& limits = {});

/// Throws Error if the limits are not 0 <= min < max (or max 0), or the share not in [0, 1].
void check_limits(const RangeLimits& limits);

/// m. A range equal to a limit but for the rounding of a file format lies within it: the same scan
/// in two formats gives the same points.
inline constexpr double range_rounding = 1e-5;

/// Adds a range to the counts; true if it is to be kept.
bool count_range(double range, const RangeLimits& limits, ImportCounts& counts);

}  // namespace planum
