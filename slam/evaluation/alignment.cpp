#include "slam/evaluation/alignment.hpp"

#include <Eigen/SVD>

namespace planum {
namespace {

/// Of the variances along the principal axes: below it, noise turns the points about the first
/// axis.
constexpr double least_variance_ratio = 1e-4;

struct CentredSums {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();  ///< means
  Eigen::Matrix3d b_a = Eigen::Matrix3d::Zero();  ///< sum of (b - mean) (a - mean)^T
};

CentredSums centred_sums(std::span<const Eigen::Vector3d> a, std::span<const Eigen::Vector3d> b) {
  CentredSums sums;
  const double count = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    sums.a += a[i] / count;
    sums.b += b[i] / count;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
    sums.b_a += (b[i] - sums.b) * (a[i] - sums.a).transpose();
  return sums;
}

/// The rotation R with the greatest trace of R^T m: Umeyama's eq. (43).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Pose pose_of(const Eigen::Matrix3d& rotation, const CentredSums& sums) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = sums.b - rotation * sums.a;
  return pose;
}

}  // namespace

std::optional<Pose> umeyama_alignment(std::span<const Eigen::Vector3d> a,
                                      std::span<const Eigen::Vector3d> b) {
  if (a.size() < 3 || a.size() != b.size()) return std::nullopt;
  const CentredSums sums = centred_sums(a, b);
  const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(sums.b_a).singularValues();
  if (!(singular[1] > least_variance_ratio * singular[0])) return std::nullopt;
  return pose_of(nearest_rotation(sums.b_a), sums);
}

Pose joint_alignment(std::span<const Pose> a, std::span<const Pose> b, double lever) {
  if (a.empty()) return Pose::Identity();
  std::vector<Eigen::Vector3d> positions_a, positions_b;
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    positions_a.push_back(a[i].translation());
    positions_b.push_back(b[i].translation());
    turns += b[i].linear() * a[i].linear().transpose();
  }
  const CentredSums sums = centred_sums(positions_a, positions_b);
  return pose_of(nearest_rotation(sums.b_a + lever * lever * turns), sums);
}

}  // namespace planum
