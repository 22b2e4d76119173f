#pragma once

#include <cstddef>
#include <span>

namespace planum {

/// As evo (Grupp 2017) has them: std over all values (not n - 1), median the mean of the two in the
/// middle. All zero if there are no values.
struct ErrorStatistics {
  double rmse = 0, mean = 0, median = 0, std = 0, min = 0, max = 0;
  double sse = 0;  ///< sum of squares
  std::size_t count = 0;
};

ErrorStatistics statistics(std::span<const double> errors);

/// The value that a share (in [0, 1]) of ascending values does not exceed, interpolated between
/// neighbours; 0 if there are none.
double quantile(std::span<const double> ascending, double share);

}  // namespace planum
