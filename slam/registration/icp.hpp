#pragma once

#include <cstddef>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/minimizers.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

struct IcpParams {
  Pairing pairing = Pairing::point_to_plane;
  Minimizer minimizer = Minimizer::svd;  ///< of pairs of points
  double first_gate = 1.0;               ///< m, how far apart the points of a pair may be at first
  double last_gate = 0;      ///< m, the same at last; 0: ten times the noise of the two scans
  double point_gate = 1.2;   ///< m, wider gates pair points with points, whatever the pairing:
                             ///< slower than planes, but from farther away
  double gate_factor = 0.5;  ///< each gate is this much of the one before
  double max_normal_angle = radians(45);  ///< rad, pairs whose surfaces face more apart are dropped
  int max_iterations = 30;                ///< at each gate
  double tolerance =
      0.02;  ///< the last gate is done when a step is less than this much of the noise
  std::size_t max_points = 5000;     ///< of the source, evenly chosen; 0: all
  std::size_t coarse_points = 1000;  ///< the same while the gate is wide; 0: all coarse ones
  std::size_t min_pairs = 50;        ///< fewer give no result
};

/// Where one scan lies in the frame of another, and how well that is known.
struct Alignment {
  Pose target_from_source = Pose::Identity();
  /// Of the error e in measured * exp_se3(e) == true, order [translation, rotation], 1/m^2 and
  /// 1/rad^2; zero along weak directions.
  Matrix6d information = Matrix6d::Zero();
  double rms = 0;      ///< m, over the pairs, in the sense of the pairing
  double overlap = 0;  ///< share of the source's points that have a pair at the last gate
  std::size_t pairs = 0;
  int iterations = 0;       ///< over all gates
  int weak_directions = 0;  ///< of six, left where the guess has them
  bool converged = false;
};

/// m; no residual is known better, however well two copies of a scan fit.
inline constexpr double least_noise = 1e-4;

/// The last gate, in standard deviations of a residual: beyond it lie wrong pairs only.
inline constexpr double gate_per_noise = 10;

/// m, standard deviation of a residual between two scans.
double pair_noise(const MatchingScan& source, const MatchingScan& target);

/// What pairs are taken at a gate (m), for scans whose points lie `spacing` (m) apart.
PairGate icp_gate(double gate, double spacing, double max_normal_angle);

/// Iterative closest points (Besl & McKay 1992; Chen & Medioni 1992), coarse to fine: the gate
/// shrinks from wide (finds the way from far) to tight (is accurate). Too few pairs, or steps that
/// do not end, are a result with `converged == false`, not an Error; with too few pairs the guess
/// is returned with no information. Throws Error if a parameter is out of range or the guess is not
/// finite.
Alignment align(const MatchingScan& source, const MatchingScan& target, const Pose& guess,
                const IcpParams& params = {});

}  // namespace planum
