#include "slam/sensor/tilted_laser.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

void check_finite(const char* name, double value) {
  if (!std::isfinite(value))
    throw Error(fmt::format("{} of the laser is {}, must be a finite number", name, value));
}

void check_laser(const TiltedLaser& laser) {
  check_finite("first beam", laser.first_beam);
  check_finite("beam step", laser.beam_step);
  check_finite("range_min", laser.min_range);
  check_finite("mount_x_m", laser.mount_x);
  check_finite("mount_z_m", laser.mount_z);
  if (!(laser.beam_interval >= 0) || !std::isfinite(laser.beam_interval))
    throw Error(
        fmt::format("time_inc_s of the laser is {}, must be at least 0", laser.beam_interval));
  if (!(laser.max_range == 0 || laser.max_range > laser.min_range))
    throw Error(fmt::format("range_max of the laser is {}, must be above range_min = {}",
                            laser.max_range, laser.min_range));
}

/// Whether the sensor itself calls it a return; NaN and infinity are left to the caller's count.
bool is_return(double range, const TiltedLaser& laser) {
  if (!std::isfinite(range)) return true;
  return range > 0 && range >= laser.min_range - range_rounding &&
         (laser.max_range == 0 || range <= laser.max_range + range_rounding);
}

std::vector<Eigen::Vector3d> beam_directions(const TiltedLaser& laser, std::size_t beams) {
  std::vector<Eigen::Vector3d> directions(beams);
  for (std::size_t b = 0; b < beams; ++b) directions[b] = beam_direction(laser, beams, b);
  return directions;
}

void append_slice(const Slice& slice, double tilt_per_beam, const TiltedLaser& laser,
                  const std::vector<Eigen::Vector3d>& directions, const RangeLimits& limits,
                  ImportedScan& result) {
  Pose mirror = scanner_from_mirror(laser, slice.tilt);
  for (std::size_t b = 0; b < directions.size(); ++b) {
    const auto source = static_cast<std::uint32_t>(result.counts.measured);
    const double range = static_cast<double>(slice.ranges[b]);
    if (!is_return(range, laser)) {
      ++result.counts.measured;
      ++result.counts.no_return;
      continue;
    }
    if (!count_range(range, limits, result.counts)) continue;
    if (tilt_per_beam != 0)
      mirror = scanner_from_mirror(laser, slice.tilt + tilt_per_beam * static_cast<double>(b));
    result.cloud.points.push_back((mirror * (range * directions[b])).cast<float>());
    result.source.push_back(source);
  }
}

}  // namespace

Eigen::Vector3d beam_direction(const TiltedLaser& laser, std::size_t beams, std::size_t beam) {
  double step = laser.beam_step;
  if (step == 0) step = beams > 1 ? pi / static_cast<double>(beams - 1) : 0;
  const double azimuth = laser.first_beam + step * static_cast<double>(beam);
  return {std::cos(azimuth), std::sin(azimuth), 0};
}

Pose scanner_from_mirror(const TiltedLaser& laser, double tilt) {
  Pose pose = Pose::Identity();
  pose.rotate(Eigen::AngleAxisd(-tilt, Eigen::Vector3d::UnitY()));
  pose.translate(Eigen::Vector3d(laser.mount_x, 0, laser.mount_z));
  return pose;
}

std::vector<double> tilt_rates(const std::vector<Slice>& slices) {
  std::vector<double> rates(slices.size(), 0.0);
  for (std::size_t s = 0; s + 1 < slices.size(); ++s) {
    const double duration = slices[s + 1].time - slices[s].time;
    if (duration > 0) rates[s] = (slices[s + 1].tilt - slices[s].tilt) / duration;
  }
  if (rates.size() > 1) rates.back() = rates[rates.size() - 2];
  return rates;
}

ImportedScan points_from_slices(const RawScan& scan, const RangeLimits& limits) {
  check_limits(limits);
  check_laser(scan.laser);
  ImportedScan result;
  const std::vector<double> rates = tilt_rates(scan.slices);
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t s = 0; s < scan.slices.size(); ++s) {
    const Slice& slice = scan.slices[s];
    if (!std::isfinite(slice.tilt))
      throw Error(fmt::format("slice {}: its tilt is {}, must be a finite number", s, slice.tilt));
    if (directions.size() != slice.ranges.size())
      directions = beam_directions(scan.laser, slice.ranges.size());
    append_slice(slice, rates[s] * scan.laser.beam_interval, scan.laser, directions, limits,
                 result);
  }
  return result;
}

}  // namespace planum
