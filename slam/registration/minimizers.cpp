#include "slam/registration/minimizers.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "slam/registration/normal_equations.hpp"

namespace planum {
namespace {

/// Sums over pairs, relative to the means of sources and targets.
struct PairSums {
  double weight = 0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero(), target_mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d target_source = Eigen::Matrix3d::Zero();  ///< of target source^T
  Eigen::Matrix3d source_source = Eigen::Matrix3d::Zero();
};

PairSums sums_of(std::span<const Pair> pairs) {
  PairSums sums;
  for (const Pair& pair : pairs) {
    sums.weight += pair.weight;
    sums.source_mean += pair.weight * pair.source;
    sums.target_mean += pair.weight * pair.target;
  }
  if (sums.weight <= 0) return sums;
  sums.source_mean /= sums.weight;
  sums.target_mean /= sums.weight;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d source = pair.source - sums.source_mean;
    sums.target_source.noalias() +=
        pair.weight * (pair.target - sums.target_mean) * source.transpose();
    sums.source_source.noalias() += pair.weight * source * source.transpose();
  }
  return sums;
}

/// The motion with this rotation that takes the mean of the sources to that of the targets.
Pose about_means(const Eigen::Matrix3d& rotation, const PairSums& sums) {
  Pose motion = Pose::Identity();
  motion.linear() = rotation;
  motion.translation() = sums.target_mean - rotation * sums.source_mean;
  return motion;
}

Eigen::Matrix3d rotation_by_svd(const PairSums& sums) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sums.target_source,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Umeyama 1991, eq. (43): the weakest axis flips rather than the handedness.
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// Horn 1987, section 4.A: the quaternion is the eigenvector of the largest eigenvalue.
Eigen::Matrix3d rotation_by_quaternion(const PairSums& sums) {
  const Eigen::Matrix3d s = sums.target_source.transpose();
  Eigen::Matrix4d n;
  n(0, 0) = s.trace();
  n.topRightCorner<1, 3>() << s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0);
  n.bottomLeftCorner<3, 1>() = n.topRightCorner<1, 3>().transpose();
  n.bottomRightCorner<3, 3>() = s + s.transpose() - s.trace() * Eigen::Matrix3d::Identity();
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// Horn, Hilden & Negahdaripour 1988: M (M^T M)^(-1/2), the third axis by the cross product, which
/// also serves where M has rank two only.
Eigen::Matrix3d rotation_by_square_root(const PairSums& sums) {
  const Eigen::Matrix3d& m = sums.target_source;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(m.transpose() * m);
  const Eigen::Vector3d u1 = eigen.eigenvectors().col(2), u2 = eigen.eigenvectors().col(1);
  if (!(eigen.eigenvalues()[2] > 0)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d b1 = (m * u1).normalized();
  Eigen::Vector3d b2 = m * u2;
  b2 -= b1.dot(b2) * b1;
  if (b2.norm() <= 1e-12 * (m * u1).norm())  // a line: the smallest turn
    return turn_between(u1, b1).toRotationMatrix();
  b2.normalize();
  return b1 * u1.transpose() + b2 * u2.transpose() + b1.cross(b2) * u1.cross(u2).transpose();
}

/// Products of quaternions (x, y, z, w) as matrices: left(a) b == right(b) a == a b.
Eigen::Matrix4d left(const Eigen::Vector3d& xyz, double w) {
  Eigen::Matrix4d m;
  m << w * Eigen::Matrix3d::Identity() + skew(xyz), xyz, -xyz.transpose(), w;
  return m;
}

Eigen::Matrix4d right(const Eigen::Vector3d& xyz, double w) {
  Eigen::Matrix4d m;
  m << w * Eigen::Matrix3d::Identity() - skew(xyz), xyz, -xyz.transpose(), w;
  return m;
}

/// Walker, Shao & Volz 1991, eq. (31) to (38), with whole position quaternions in place of halves.
Pose motion_by_dual_quaternion(std::span<const Pair> pairs, const PairSums& sums) {
  // Relative to the mean of the sources, so that far-away points lose no digits.
  Eigen::Matrix4d c1 = Eigen::Matrix4d::Zero(), c3 = c1;
  for (const Pair& pair : pairs) {
    const Eigen::Matrix4d source = right(pair.source - sums.source_mean, 0);
    const Eigen::Matrix4d target = left(pair.target - sums.source_mean, 0);
    c1.noalias() -= 2 * pair.weight * target.transpose() * source;
    c3 += 2 * pair.weight * (source - target);
  }
  const Eigen::Matrix4d a = c3.transpose() * c3 / (4 * sums.weight) - 0.5 * (c1 + c1.transpose());
  const Eigen::Vector4d r = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(a).eigenvectors().col(3);
  const Eigen::Vector4d s = -c3 * r / (2 * sums.weight);
  Pose motion = Pose::Identity();
  motion.linear() = Eigen::Quaterniond(r[3], r[0], r[1], r[2]).toRotationMatrix();
  motion.translation() = (right(r.head<3>(), r[3]).transpose() * s).head<3>() + sums.source_mean -
                         motion.linear() * sums.source_mean;
  return motion;
}

/// The least x with a x = b, for a symmetric positive semidefinite.
template <int N>
Eigen::Matrix<double, N, 1> least_solution(const Eigen::Matrix<double, N, N>& a,
                                           const Eigen::Matrix<double, N, 1>& b) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(a);
  const double negligible = 1e-12 * eigen.eigenvalues()[N - 1];
  Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::Zero();
  for (int k = 0; k < N; ++k) {
    const auto axis = eigen.eigenvectors().col(k);
    if (eigen.eigenvalues()[k] > negligible) x += axis.dot(b) / eigen.eigenvalues()[k] * axis;
  }
  return x;
}

/// The small rotation vector r with source + r x source nearest to the targets, about the means.
Eigen::Vector3d small_turn(const PairSums& sums) {
  const Eigen::Matrix3d& ss = sums.source_source;
  const Eigen::Matrix3d& ts = sums.target_source;
  const Eigen::Vector3d moment(ts(2, 1) - ts(1, 2), ts(0, 2) - ts(2, 0), ts(1, 0) - ts(0, 1));
  return least_solution<3>(ss.trace() * Eigen::Matrix3d::Identity() - ss, moment);
}

Pose motion_by_small_angle(const PairSums& sums) {
  Vector6d twist;
  twist << sums.target_mean - sums.source_mean, small_turn(sums);
  return motion_about(sums.source_mean, twist);
}

/// Pottmann, Leopoldseder & Hofer 2002: the velocity v(x) = c0 + c x x with least squares is that
/// of a screw about an axis; points follow it by the angle whose tangent is |c|.
Pose motion_by_helix(const PairSums& sums) {
  const Eigen::Vector3d c = small_turn(sums);
  const Eigen::Vector3d c0 = sums.target_mean - sums.source_mean - c.cross(sums.source_mean);
  const double speed = c.norm();
  Pose motion = Pose::Identity();
  if (speed < 1e-12) {
    motion.translation() = c0;
    return motion;
  }
  const Eigen::Vector3d axis = c / speed;
  const Eigen::Vector3d place = c.cross(c0) / (speed * speed);  // on the axis
  const double angle = std::atan(speed), pitch = axis.dot(c0) / speed;
  motion.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  motion.translation() = place - motion.linear() * place + pitch * angle * axis;
  return motion;
}

/// Borrmann et al. 2008, eq. (9) to (13): target - source is M D at the midpoint of each pair. With
/// the turn by Cayley's formula that is exact for pairs without errors.
Pose motion_by_lu_milios(std::span<const Pair> pairs, const PairSums& sums) {
  const Eigen::Vector3d centre = 0.5 * (sums.source_mean + sums.target_mean);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d middle = 0.5 * (pair.source + pair.target) - centre;
    squares += pair.weight *
               (middle.squaredNorm() * Eigen::Matrix3d::Identity() - middle * middle.transpose());
    moment += pair.weight * middle.cross(pair.target - pair.source);
  }
  const Eigen::Vector3d turn = least_solution<3>(squares, moment);  // 2 tan(angle / 2), on the axis
  const Eigen::Quaterniond q(1, 0.5 * turn.x(), 0.5 * turn.y(), 0.5 * turn.z());
  return about_means(q.normalized().toRotationMatrix(), sums);
}

}  // namespace

Pose rigid_motion(std::span<const Pair> pairs, Minimizer minimizer) {
  const PairSums sums = sums_of(pairs);
  if (sums.weight <= 0) return Pose::Identity();
  switch (minimizer) {
    case Minimizer::svd:
      return about_means(rotation_by_svd(sums), sums);
    case Minimizer::quaternion:
      return about_means(rotation_by_quaternion(sums), sums);
    case Minimizer::dual_quaternion:
      return motion_by_dual_quaternion(pairs, sums);
    case Minimizer::orthonormal:
      return about_means(rotation_by_square_root(sums), sums);
    case Minimizer::helix:
      return motion_by_helix(sums);
    case Minimizer::small_angle:
      return motion_by_small_angle(sums);
    case Minimizer::lu_milios:
      return motion_by_lu_milios(pairs, sums);
  }
  return Pose::Identity();
}

}  // namespace planum
