#include "slam/registration/icp.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/registration/minimizers.hpp"
#include "slam/registration/normal_equations.hpp"

namespace planum {
namespace {

/// While the gate is wider than this many last gates, few points show the way well enough.
constexpr double coarse_gates = 4;
/// A gate before the last is done when a step is less than this much of it; pairs of points take
/// many small steps.
constexpr double step_per_gate = 0.05, point_step_per_gate = 0.005;
/// Searches reach at least so many point spacings, or sparse parts of the target have no pairs.
constexpr double search_per_spacing = 4;

void check(const IcpParams& params, const Pose& guess) {
  const auto require = [](bool good, const char* option, auto value, const char* limit) {
    if (!good)
      throw Error(fmt::format("registration: {} must be {}, got {}", option, limit, value));
  };
  require(params.first_gate > 0 && std::isfinite(params.first_gate), "first_gate",
          params.first_gate, "> 0 m");
  require(params.last_gate >= 0 && params.last_gate <= params.first_gate, "last_gate",
          params.last_gate, "between 0 and first_gate");
  require(params.point_gate >= 0, "point_gate", params.point_gate, ">= 0 m");
  require(params.gate_factor > 0 && params.gate_factor < 1, "gate_factor", params.gate_factor,
          "between 0 and 1");
  require(params.max_normal_angle > 0 && params.max_normal_angle <= pi, "max_normal_angle",
          degrees(params.max_normal_angle), "between 0 and 180 deg");
  require(params.max_iterations > 0, "max_iterations", params.max_iterations, "> 0");
  require(params.tolerance > 0, "tolerance", params.tolerance, "> 0");
  require(params.min_pairs >= 6, "min_pairs", params.min_pairs, ">= 6");
  if (!guess.matrix().allFinite()) throw Error("registration: the guess is not finite");
}

std::vector<double> gates(const IcpParams& params, double noise) {
  const double last =
      params.last_gate > 0 ? params.last_gate : std::min(params.first_gate, gate_per_noise * noise);
  std::vector<double> result;
  for (double gate = params.first_gate; gate > last; gate *= params.gate_factor)
    result.push_back(gate);
  result.push_back(last);
  return result;
}

/// m, how far a motion moves the points of the equations, rms.
double displacement(const Pose& motion, const NormalEquations& equations) {
  const Eigen::Vector3d shift = motion * equations.centre - equations.centre;
  return std::hypot(shift.norm(), rotation_angle(motion) * equations.radius);
}

/// The matching of one pair of scans while it runs.
class Matching {
 public:
  Matching(const MatchingScan& source, const MatchingScan& target, const Pose& guess,
           const IcpParams& params)
      : params_(params),
        spacing_(std::max(source.spacing, target.spacing)),
        noise_(pair_noise(source, target)),
        guess_(guess),
        coarse_(source, target, source.coarse_selection(params.coarse_points)),
        fine_(source, target, source.selection(params.max_points)) {}

  Alignment run() {
    Alignment result{.target_from_source = guess_};
    const std::vector<double> all = gates(params_, noise_);
    for (const double gate : all) {
      const bool last = gate == all.back();
      const bool coarse = gate > coarse_gates * all.back() && coarse_.selected() < fine_.selected();
      if (!run_gate(coarse ? coarse_ : fine_, gate, last, result))
        return {.target_from_source = guess_};
    }
    return result;
  }

 private:
  /// Iterates at one gate; false if there are too few pairs.
  bool run_gate(PairFinder& finder, double gate, bool last, Alignment& result) {
    const PairGate pair_gate = icp_gate(gate, spacing_, params_.max_normal_angle);
    const bool points =
        params_.pairing == Pairing::point_to_point || (!last && gate > params_.point_gate);
    const Pairing pairing = points ? Pairing::point_to_point : params_.pairing;
    const double rest = gate * (points ? point_step_per_gate : step_per_gate);
    for (int i = 0; i < params_.max_iterations; ++i) {
      const std::vector<Pair> pairs = finder.find(result.target_from_source, pairing, pair_gate);
      if (pairs.size() < params_.min_pairs) return false;
      const NormalEquations equations = normal_equations(pairs, pairing);
      const Determined system = determined(equations);
      const Pose motion = points ? rigid_motion(pairs, params_.minimizer)
                                 : determined_motion(equations, system, result.target_from_source);
      result.target_from_source = orthonormalized(motion * result.target_from_source);
      ++result.iterations;
      const double moved = displacement(motion, equations);
      result.converged = last && moved < params_.tolerance * noise_;
      if (last) note_quality(equations, system, finder, result);
      if (result.converged || (!last && moved < rest)) break;
    }
    return true;
  }

  /// The solution, and along weak directions back to the guess: with a wider gate they may have
  /// seemed determined, by wrong pairs.
  Pose determined_motion(const NormalEquations& equations, const Determined& system,
                         const Pose& target_from_source) const {
    const Pose back = guess_ * target_from_source.inverse();
    const Eigen::AngleAxisd turn(back.linear());
    Vector6d twist;
    twist << back * equations.centre - equations.centre, turn.angle() * turn.axis();
    return motion_about(equations.centre, system.solution + system.weak_part * twist);
  }

  void note_quality(const NormalEquations& equations, const Determined& system,
                    const PairFinder& finder, Alignment& result) const {
    result.pairs = equations.pairs;
    result.rms = equations.rms();
    result.overlap = static_cast<double>(equations.pairs) / static_cast<double>(finder.selected());
    result.weak_directions = system.weak_directions;
    // exp_se3(x) T == T exp_se3(e) with x = adjoint(T) e; x is about the target's origin.
    const Matrix6d twist_from_error =
        twist_about(equations.centre) * adjoint(result.target_from_source);
    const double variance = equations.residual_variance() * finder.redundancy(params_.pairing);
    result.information =
        twist_from_error.transpose() * (system.hessian / variance) * twist_from_error;
  }

  const IcpParams& params_;
  double spacing_, noise_;
  const Pose& guess_;
  PairFinder coarse_, fine_;
};

}  // namespace

double pair_noise(const MatchingScan& source, const MatchingScan& target) {
  return std::max(least_noise, std::hypot(source.noise, target.noise));
}

PairGate icp_gate(double gate, double spacing, double max_normal_angle) {
  return {.distance = std::max(gate, search_per_spacing * spacing),
          .residual = gate,
          .max_normal_angle = max_normal_angle};
}

Alignment align(const MatchingScan& source, const MatchingScan& target, const Pose& guess,
                const IcpParams& params) {
  check(params, guess);
  return Matching(source, target, guess, params).run();
}

}  // namespace planum
