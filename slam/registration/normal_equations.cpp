#include "slam/registration/normal_equations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slam/core/symmetric_eigen.hpp"

namespace planum {
namespace {

/// A direction is determined if its eigenvalue is so many times that of tilt noise alone.
constexpr double least_signal_to_noise = 3;
/// rad; normals are off by so much where surfaces are no planes, however well planes fit.
const double least_tilt = radians(2);
/// Below this share of the pairs' weight a direction is undetermined for numerical reasons alone.
constexpr double least_eigenvalue = 1e-6;
/// m^2; no range is better than a tenth of a millimetre, however well two copies of a scan fit.
constexpr double least_variance = 1e-8;

/// Count, weight, centre, radius and tilt, which do not depend on the kind of residual.
NormalEquations summary(std::span<const Pair> pairs) {
  NormalEquations result;
  result.pairs = pairs.size();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) {
    result.weight += pair.weight;
    result.tilt_variance += pair.weight * pair.tilt_variance;
    sum += pair.weight * pair.source;
  }
  if (result.weight == 0) return result;
  result.tilt_variance = std::max(result.tilt_variance / result.weight, least_tilt * least_tilt);
  result.centre = sum / result.weight;
  double squared = 0;
  for (const Pair& pair : pairs)
    squared += pair.weight * (pair.source - result.centre).squaredNorm();
  result.radius = std::sqrt(squared / result.weight);
  return result;
}

/// Residual n.(p - q); turning moves the places `lever(pair)`.
template <class Lever>
NormalEquations equations_along_normals(std::span<const Pair> pairs, const Lever& lever) {
  NormalEquations result = summary(pairs);
  for (const Pair& pair : pairs) {
    const double residual = pair.normal.dot(pair.source - pair.target);
    Vector6d derivative;
    derivative << pair.normal, (lever(pair) - result.centre).cross(pair.normal);
    const Vector6d weighted = pair.weight * derivative;
    result.hessian.noalias() += weighted * derivative.transpose();
    result.gradient += weighted * residual;
    result.squared_residuals += pair.weight * residual * residual;
  }
  return result;
}

/// Residual p - q, measured by `metric(pair)`: a number or a matrix.
template <class Metric>
NormalEquations equations_of_points(std::span<const Pair> pairs, const Metric& metric) {
  NormalEquations result = summary(pairs);
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d residual = pair.source - pair.target;
    Eigen::Matrix<double, 3, 6> derivative;
    derivative << Eigen::Matrix3d::Identity(), -skew(pair.source - result.centre);
    const auto weight = metric(pair);
    const Eigen::Matrix<double, 6, 3> weighted = derivative.transpose() * weight;
    result.hessian.noalias() += weighted * derivative;
    result.gradient += weighted * residual;
    result.squared_residuals += residual.dot(weight * residual);
  }
  return result;
}

}  // namespace

double NormalEquations::rms() const {
  return weight > 0 ? std::sqrt(squared_residuals / weight) : 0;
}

double NormalEquations::residual_variance() const {
  const double equations = static_cast<double>(equations_per_pair) * static_cast<double>(pairs);
  const double freedom = equations - 6;
  if (freedom <= 0 || weight <= 0) return std::numeric_limits<double>::infinity();
  // Weights count relative to each other, so that a weak mean weight is no large variance.
  return std::max(least_variance,
                  squared_residuals / weight * (static_cast<double>(pairs) / freedom));
}

NormalEquations point_to_plane_equations(std::span<const Pair> pairs) {
  return equations_along_normals(pairs, [](const Pair& pair) { return pair.source; });
}

NormalEquations symmetric_equations(std::span<const Pair> pairs) {
  return equations_along_normals(
      pairs, [](const Pair& pair) -> Eigen::Vector3d { return 0.5 * (pair.source + pair.target); });
}

NormalEquations point_to_point_equations(std::span<const Pair> pairs) {
  NormalEquations result = equations_of_points(pairs, [](const Pair& pair) { return pair.weight; });
  result.equations_per_pair = 3;
  // The normals do not enter, nor do their errors.
  result.tilt_variance = 0;
  return result;
}

NormalEquations plane_to_plane_equations(std::span<const Pair> pairs) {
  return equations_of_points(
      pairs, [](const Pair& pair) -> Eigen::Matrix3d { return pair.weight * pair_metric(pair); });
}

NormalEquations normal_equations(std::span<const Pair> pairs, Pairing pairing) {
  switch (pairing) {
    case Pairing::point_to_point:
      return point_to_point_equations(pairs);
    case Pairing::point_to_plane:
      return point_to_plane_equations(pairs);
    case Pairing::plane_to_plane:
      return plane_to_plane_equations(pairs);
    case Pairing::symmetric:
      return symmetric_equations(pairs);
  }
  return {};
}

Determined determined(const NormalEquations& equations) {
  Determined result;
  if (equations.weight <= 0 || equations.radius <= 0) {
    result.weak_directions = 6;
    result.weak_part.setIdentity();
    return result;
  }
  // Metres for all six: a rotation counts by what it moves at the radius.
  Vector6d scale;
  scale << 1, 1, 1, Eigen::Vector3d::Constant(1 / equations.radius);
  const Matrix6d per_pair =
      scale.asDiagonal() * (equations.hessian / equations.weight) * scale.asDiagonal();
  const Vector6d gradient = scale.asDiagonal() * (equations.gradient / equations.weight);
  const SymmetricEigen<6> eigen = symmetric_eigen(per_pair);
  const double threshold =
      std::max(least_eigenvalue, least_signal_to_noise * equations.tilt_variance);
  for (int i = 0; i < 6; ++i) {
    const double eigenvalue = eigen.values[i];
    const Vector6d direction = eigen.vectors.col(i);
    if (eigenvalue < threshold) {
      ++result.weak_directions;
      result.weak_part += direction * direction.transpose();
      continue;
    }
    const double along = direction.dot(gradient);
    result.solution -= direction * (along / eigenvalue);
    result.gradient += direction * along;
    result.hessian += (eigenvalue - equations.tilt_variance) * direction * direction.transpose();
  }
  const Vector6d per_scale = scale.cwiseInverse();
  result.solution = scale.asDiagonal() * result.solution;
  result.weak_part = scale.asDiagonal() * result.weak_part * per_scale.asDiagonal();
  result.gradient = equations.weight * (per_scale.asDiagonal() * result.gradient);
  result.hessian =
      equations.weight * (per_scale.asDiagonal() * result.hessian * per_scale.asDiagonal());
  return result;
}

Pose motion_about(const Eigen::Vector3d& centre, const Vector6d& twist) {
  Pose turn = Pose::Identity();
  turn.linear() = exp_se3(twist).linear();
  turn.translation() = twist.head<3>();
  return Eigen::Translation3d(centre) * turn * Eigen::Translation3d(-centre);
}

Matrix6d twist_about(const Eigen::Vector3d& centre) {
  Matrix6d m = Matrix6d::Identity();
  m.topRightCorner<3, 3>() = -skew(centre);
  return m;
}

}  // namespace planum
