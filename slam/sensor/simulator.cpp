#include "slam/sensor/simulator.hpp"

#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/sensor/random_numbers.hpp"
#include "slam/sensor/tilted_laser.hpp"

namespace planum {
namespace {

constexpr std::size_t rim_rays = 4;
/// Rays at this part of the beam's radius stand for the light around its axis.
constexpr double rim_radius = 0.7;

void check_range(const char* option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(
        fmt::format("{} is {:.6g}, must be between {:.6g} and {:.6g}", option, value, low, high));
}

void check(const SimulatorParams& params) {
  if (params.beams < 2) throw Error(fmt::format("beams is {}, must be at least 2", params.beams));
  if (params.slices < 2)
    throw Error(fmt::format("slices is {}, must be at least 2", params.slices));
  check_range("min_tilt_deg", degrees(params.min_tilt), -180, 180);
  check_range("max_tilt_deg", degrees(params.max_tilt), degrees(params.min_tilt), 180);
  check_range("slice_interval_s", params.slice_interval, 0, 1e3);
  check_range("range_max_m", params.laser.max_range, params.laser.min_range, 1e6);
  check_range("range_noise_m", params.range_noise, 0, 10);
  check_range("drop_out", params.drop_out, 0, 1);
  check_range("grazing_drop_out", params.grazing_drop_out, 0, 1);
  check_range("grazing_angle_deg", degrees(params.grazing_angle), 0, 90);
  check_range("beam_width_deg", degrees(params.beam_width), 0, 10);
  check_range("mixed_pixel", params.mixed_pixel, 0, 1);
  check_range("mixed_pixel_gap_m", params.mixed_pixel_gap, 0, 1e6);
}

struct Beam {
  Eigen::Vector3d origin;     ///< m, the mirror
  Eigen::Vector3d direction;  ///< unit
  Eigen::Vector3d up;         ///< unit, across the slice plane
};

struct Return {
  double range = 0;  ///< m, 0: none
  std::uint32_t triangle = no_triangle;
};

/// Whether the receiver misses the echo of a surface that the beam meets this steeply.
bool drops_out(double cos_incidence, const SimulatorParams& params, RandomNumbers& random) {
  const double sin_grazing = std::sin(params.grazing_angle);
  double kept = 1 - params.drop_out;
  // The sine of the angle between beam and surface is the cosine of the incidence.
  if (cos_incidence < sin_grazing)
    kept *= 1 - params.grazing_drop_out * (1 - cos_incidence / sin_grazing);
  return random.uniform() >= kept;
}

/// The range of the other surface in the beam's cone, and how many rays at its rim met it.
struct OtherSurface {
  double range = 0;
  std::size_t rays = 0;
};

/// Looks around the beam's axis. A ray at the rim belongs to another surface if it ends away from
/// where the plane that the axis hit would have stopped it: slanted surfaces alone do not count.
OtherSurface other_surface(const Beam& beam, const RayHit& hit, const RayCaster& caster,
                           const SimulatorParams& params, RandomNumbers& random) {
  const Eigen::Vector3d normal = hit.normal.cast<double>();
  const Eigen::Vector3d side = beam.direction.cross(beam.up);
  const double opening = rim_radius * std::tan(params.beam_width / 2);
  const double turn = random.uniform(0, 2 * pi / rim_rays);
  OtherSurface other;
  for (std::size_t i = 0; i < rim_rays; ++i) {
    const double angle = turn + 2 * pi * static_cast<double>(i) / rim_rays;
    const Eigen::Vector3d direction =
        (beam.direction + opening * (std::cos(angle) * side + std::sin(angle) * beam.up))
            .normalized();
    const auto rim = caster.cast(beam.origin, direction, params.laser.max_range);
    if (!rim) continue;
    const double expected = hit.distance * normal.dot(beam.direction) / normal.dot(direction);
    const bool on_plane = std::abs(rim->distance - expected) <= params.mixed_pixel_gap;
    if (on_plane || std::abs(rim->distance - hit.distance) <= params.mixed_pixel_gap) continue;
    other.range += rim->distance;
    ++other.rays;
  }
  if (other.rays > 0) other.range /= static_cast<double>(other.rays);
  return other;
}

/// Measures along one beam. The random numbers are drawn in a fixed order.
Return measured(const Beam& beam, const RayCaster& caster, const SimulatorParams& params,
                RandomNumbers& random) {
  const auto hit = caster.cast(beam.origin, beam.direction, params.laser.max_range);
  if (!hit) return {};
  const double cos_incidence = std::abs(hit->normal.cast<double>().dot(beam.direction));
  if (drops_out(cos_incidence, params, random)) return {};
  Return result{hit->distance, hit->triangle};
  if (random.uniform() < params.mixed_pixel) {
    const OtherSurface other = other_surface(beam, *hit, caster, params, random);
    if (other.rays > 0) {
      // The echo's time is the mean over the light of the cone; rays stand for parts of it.
      const double share = (static_cast<double>(other.rays) - random.uniform()) / rim_rays;
      result = {hit->distance + share * (other.range - hit->distance), no_triangle};
    }
  }
  result.range += params.range_noise * random.normal();
  if (result.range <= params.laser.min_range || result.range > params.laser.max_range) return {};
  return result;
}

std::vector<Slice> empty_slices(const SimulatorParams& params) {
  std::vector<Slice> slices(params.slices);
  const double step = (params.max_tilt - params.min_tilt) / static_cast<double>(slices.size() - 1);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    slices[s].time = static_cast<double>(s) * params.slice_interval;
    slices[s].tilt = params.min_tilt + static_cast<double>(s) * step;
    slices[s].ranges.resize(params.beams);
  }
  return slices;
}

void measure_slice(const RayCaster& model, const Pose& model_from_scan, std::uint64_t number,
                   const SimulatorParams& params, std::size_t s, double tilt_rate,
                   SimulatedScan& result) {
  Slice& slice = result.scan.slices[s];
  const double tilt_per_beam = tilt_rate * params.laser.beam_interval;
  for (std::size_t b = 0; b < params.beams; ++b) {
    const double tilt = slice.tilt + tilt_per_beam * static_cast<double>(b);
    const Pose mirror = model_from_scan * scanner_from_mirror(params.laser, tilt);
    const Beam beam{mirror.translation(),
                    mirror.linear() * beam_direction(params.laser, params.beams, b),
                    mirror.linear().col(2)};
    RandomNumbers random({params.seed, number, s, b});
    const Return echo = measured(beam, model, params, random);
    slice.ranges[b] = static_cast<float>(echo.range);
    result.triangle[s * params.beams + b] = echo.triangle;
  }
}

}  // namespace

SimulatedScan simulate_scan(const RayCaster& model, const Pose& model_from_scan,
                            std::uint64_t number, const SimulatorParams& params) {
  check(params);
  SimulatedScan result;
  result.scan.laser = params.laser;
  result.scan.slices = empty_slices(params);
  result.triangle.assign(params.slices * params.beams, no_triangle);
  const std::vector<double> rates = tilt_rates(result.scan.slices);
  parallel_for(params.slices, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      measure_slice(model, model_from_scan, number, params, s, rates[s], result);
  });
  return result;
}

std::vector<SimulatedScan> simulate_scans(const TriangleMesh& model,
                                          std::span<const Pose> model_from_scan,
                                          const SimulatorParams& params, const Progress& progress) {
  check(params);
  const RayCaster caster(model);
  std::vector<SimulatedScan> scans;
  for (std::size_t i = 0; i < model_from_scan.size(); ++i) {
    scans.push_back(simulate_scan(caster, model_from_scan[i], i, params));
    progress.report(i + 1, model_from_scan.size());
  }
  return scans;
}

}  // namespace planum
