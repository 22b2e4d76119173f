#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/core/progress.hpp"
#include "slam/core/raw_scan.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "slam/sensor/ray_caster.hpp"

namespace planum {

/// A virtual tilting laser and its faults; the defaults resemble a SICK LMS 200 on a nodding mount.
struct SimulatorParams {
  TiltedLaser laser = {.min_range = 0.05, .max_range = 32.0};  ///< how beams lie in a slice
  std::size_t beams = 361;         ///< of a slice; with the laser's default step half a turn
  std::size_t slices = 251;        ///< of a scan
  double min_tilt = radians(-55);  ///< rad, of the first slice
  double max_tilt = radians(70);   ///< rad, of the last slice
  double slice_interval = 0.0267;  ///< s between slices

  double range_noise = 0.01;           ///< m, standard deviation
  double drop_out = 0.002;             ///< probability that a beam gives no return
  double grazing_drop_out = 0.5;       ///< the same for a beam that only just touches a surface ...
  double grazing_angle = radians(10);  ///< rad, ... falling to 0 where it meets it at this angle

  double beam_width = radians(0.4);  ///< rad, full opening angle of the cone of light
  double mixed_pixel = 0.5;  ///< probability of a blend where the cone meets two surfaces; 0: none
  double mixed_pixel_gap = 0.05;  ///< m, surfaces this far apart along the beam are two

  std::uint64_t seed = 1;
};

/// The triangle of a beam that gave no return, or fell between two surfaces.
inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

/// A virtual scan and what its beams saw.
struct SimulatedScan {
  RawScan scan;
  std::vector<std::uint32_t> triangle;  ///< for each beam, slice by slice: what it hit in the model
};

/// Scans a model from one place by ray casting. `number` tells the scans of one seed apart.
/// The same on any number of threads. Throws Error if a parameter is out of its range.
SimulatedScan simulate_scan(const RayCaster& model, const Pose& model_from_scan,
                            std::uint64_t number, const SimulatorParams& params = {});

/// Scans a model from each of the poses, numbered from 0.
std::vector<SimulatedScan> simulate_scans(const TriangleMesh& model,
                                          std::span<const Pose> model_from_scan,
                                          const SimulatorParams& params = {},
                                          const Progress& progress = {});

}  // namespace planum
