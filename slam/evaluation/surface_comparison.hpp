#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"
#include "slam/evaluation/surface_tree.hpp"

namespace planum {

/// Distances of points to a surface, m.
struct SurfaceDistances {
  std::size_t count = 0;
  double mean = 0, rms = 0, median = 0, percentile_90 = 0, max = 0;
  double share_within = 0;  ///< of the points, not farther than `within`
  double within = 0;        ///< m
};

/// The figures of distances, in any order.
SurfaceDistances distance_figures(std::vector<double> distances, double within = 0.02);

/// Throws Error if a point is not finite or within is negative. All zero if there are no points.
SurfaceDistances surface_distances(std::span<const Eigen::Vector3d> points,
                                   const SurfaceTree& surface, double within = 0.02);

struct SurfaceFitParams {
  double first_gate = 1.0;  ///< m, points farther from the surface are left out at first
  double last_gate = 0.1;   ///< m, the same at last; each gate is half the one before
  int max_iterations = 30;  ///< at each gate
  double tolerance = 1e-6;  ///< m and rad; a gate is done when a step is smaller
};

struct SurfaceFit {
  Pose surface_from_points = Pose::Identity();
  double rms = 0;  ///< m, of the points within the last gate
  std::size_t count = 0;
  bool converged = false;
};

/// Lays points onto a surface, from a guess: Gauss-Newton over the distances to the tangent planes
/// of the nearest points (Chen & Medioni 1992), weighted by Tukey's biweight with the gate as its
/// limit. Directions that no point determines stay as guessed. Throws Error if a point or the guess
/// is not finite, fewer than six points are near the surface, or a parameter is out of range.
SurfaceFit fit_to_surface(std::span<const Eigen::Vector3d> points, const SurfaceTree& surface,
                          const Pose& guess, const SurfaceFitParams& params = {});

}  // namespace planum
