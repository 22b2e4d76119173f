#pragma once

#include <cstddef>
#include <span>

#include "slam/core/pose.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

/// Least squares over pairs for a small motion of the source, x -> x + t + r x (x - centre) with
/// the twist [t; r]: squared residuals are minimal where hessian * twist == -gradient.
struct NormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, mean of the source points
  double radius = 0;             ///< m, rms distance of the source points from the centre
  double weight = 0;             ///< sum of the weights
  double squared_residuals = 0;  ///< m^2, weighted sum
  double tilt_variance = 0;      ///< rad^2, weighted mean
  std::size_t pairs = 0;
  int equations_per_pair = 1;

  double rms() const;                ///< m, weighted root mean square residual
  double residual_variance() const;  ///< m^2, over the degrees of freedom left; infinite if none
};

/// Point to plane: residual n.(p - q), derivative [n, (p - c) x n] (Chen & Medioni 1992).
NormalEquations point_to_plane_equations(std::span<const Pair> pairs);

/// Point to point: residual p - q, derivative M = [I, -skew(p - c)] (Lu & Milios 1997, in 3D).
NormalEquations point_to_point_equations(std::span<const Pair> pairs);

/// Plane to plane: residual p - q as point to point, measured by pair_metric() (Segal et al. 2009).
NormalEquations plane_to_plane_equations(std::span<const Pair> pairs);

/// Symmetric: residual n.(p - q) with n along the mean of both normals; turned half on either side,
/// so that the derivative is [n, (m - c) x n] with the middle m of p and q (Rusinkiewicz 2019).
NormalEquations symmetric_equations(std::span<const Pair> pairs);

NormalEquations normal_equations(std::span<const Pair> pairs, Pairing pairing);

/// What the pairs determine. A direction in which the mean square derivative of the residuals
/// (rotations scaled by the radius) is not well above what the tilt errors of the normals alone
/// make is weak. (Zhang, Kaess & Singh: On degeneracy of optimization-based state estimation
/// problems, ICRA 2016, with the threshold from the noise.)
struct Determined {
  Matrix6d hessian = Matrix6d::Zero();    ///< zero along weak directions, and without tilt errors
  Vector6d gradient = Vector6d::Zero();   ///< zero along weak directions
  Vector6d solution = Vector6d::Zero();   ///< the twist that solves the equations, zero along them
  Matrix6d weak_part = Matrix6d::Zero();  ///< takes a twist to its part along weak directions
  int weak_directions = 0;                ///< of six
};

Determined determined(const NormalEquations& equations);

/// The motion x -> x + t + r x (x - centre) for a twist [t; r], as a rigid one.
Pose motion_about(const Eigen::Vector3d& centre, const Vector6d& twist);

/// Maps a twist about the origin to the twist about `centre` that moves points the same way.
Matrix6d twist_about(const Eigen::Vector3d& centre);

}  // namespace planum
