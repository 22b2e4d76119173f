#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/core/raw_scan.hpp"
#include "slam/sensor/range_limits.hpp"

namespace planum {

/// A raw scan as points in the scanner's frame: origin on the tilt axis, which points left (y);
/// x forward and z up at tilt 0. A beam of azimuth a and range r at tilt t ends at
///   R_y(-t) (mount_x + r cos a, r sin a, mount_z),
/// so the mirror goes round the axis with the laser, and a positive tilt looks up.
/// Ranges that are 0, negative, or outside the laser's own limits are no returns; NaN and infinity
/// are too, but are counted apart. Throws Error if limits, header or a tilt are not usable numbers.
ImportedScan points_from_slices(const RawScan& scan, const RangeLimits& limits = {});

/// The direction of a beam within the slice plane (z = 0), unit; its azimuth grows
/// counter-clockwise seen from above. `beams` is how many beams a slice has.
Eigen::Vector3d beam_direction(const TiltedLaser& laser, std::size_t beams, std::size_t beam);

/// Where the mirror is at a tilt, and how its slice plane lies.
Pose scanner_from_mirror(const TiltedLaser& laser, double tilt);

/// How fast the tilt changes during each slice, rad/s: on the way to the next slice, the last one
/// going on as the one before; 0 where times do not grow. With it, beam b of slice s is
/// measured at a tilt of slices[s].tilt + rate[s] * b * laser.beam_interval.
std::vector<double> tilt_rates(const std::vector<Slice>& slices);

}  // namespace planum
