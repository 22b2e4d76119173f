#include "slam/sensor/range_limits.hpp"

#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

double percent(std::size_t part, std::size_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

template <typename T>
void append_if_there(const std::vector<T>& from, std::size_t i, std::vector<T>& to) {
  if (!from.empty()) to.push_back(from[i]);
}

}  // namespace

void check_limits(const RangeLimits& limits) {
  if (!(limits.min_range >= 0) || !std::isfinite(limits.min_range))
    throw Error(fmt::format("min_range_m is {}, must be at least 0", limits.min_range));
  if (!(limits.max_range == 0 || limits.max_range > limits.min_range))
    throw Error(fmt::format("max_range_m is {}, must be above min_range_m = {} (or 0: no limit)",
                            limits.max_range, limits.min_range));
  if (!(limits.max_not_finite >= 0 && limits.max_not_finite <= 1))
    throw Error(
        fmt::format("max_not_finite is {}, must be between 0 and 1", limits.max_not_finite));
}

bool count_range(double range, const RangeLimits& limits, ImportCounts& counts) {
  ++counts.measured;
  if (!std::isfinite(range)) {
    ++counts.not_finite;
  } else if (range < limits.min_range - range_rounding) {
    ++counts.too_near;
  } else if (limits.max_range > 0 && range > limits.max_range + range_rounding) {
    ++counts.too_far;
  } else {
    ++counts.kept;
    return true;
  }
  return false;
}

ImportedScan limited(const Cloud& scan, const RangeLimits& limits) {
  check_limits(limits);
  ImportedScan result;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!count_range(scan.points[i].cast<double>().norm(), limits, result.counts)) continue;
    result.cloud.points.push_back(scan.points[i]);
    append_if_there(scan.normals, i, result.cloud.normals);
    append_if_there(scan.intensity, i, result.cloud.intensity);
    append_if_there(scan.scan, i, result.cloud.scan);
    result.source.push_back(static_cast<std::uint32_t>(i));
  }
  return result;
}

void check_import(const ImportCounts& counts, const RangeLimits& limits) {
  if (counts.measured == 0) throw Error("the scan is empty: it holds no measurement");
  const double allowed = limits.max_not_finite * static_cast<double>(counts.measured);
  if (static_cast<double>(counts.not_finite) > allowed)
    throw Error(fmt::format(
        "{} of {} ranges are NaN or infinite ({:.1f} %, at most {:.1f} % are allowed): the scan "
        "looks damaged; record or convert it again, or leave it out",
        counts.not_finite, counts.measured, percent(counts.not_finite, counts.measured),
        100 * limits.max_not_finite));
  if (counts.kept == 0)
    throw Error(fmt::format(
        "none of {} measurements is left: {} without return, {} NaN or infinite, {} nearer than "
        "min_range_m = {}, {} farther than max_range_m = {}; check these limits and the unit of "
        "the file",
        counts.measured, counts.no_return, counts.not_finite, counts.too_near, limits.min_range,
        counts.too_far, limits.max_range));
}

}  // namespace planum
