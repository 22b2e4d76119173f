#include "slam/registration/point_to_point.hpp"

#include <Eigen/SVD>

namespace planum {

Pose closed_form_motion(std::span<const Pair> pairs) {
  double weight = 0;
  Eigen::Vector3d source_mean = Eigen::Vector3d::Zero(), target_mean = source_mean;
  for (const Pair& pair : pairs) {
    weight += pair.weight;
    source_mean += pair.weight * pair.source;
    target_mean += pair.weight * pair.target;
  }
  if (weight <= 0) return Pose::Identity();
  source_mean /= weight;
  target_mean /= weight;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Pair& pair : pairs)
    covariance.noalias() +=
        pair.weight * (pair.target - target_mean) * (pair.source - source_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Umeyama 1991, eq. (43): the weakest axis flips rather than the handedness.
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  Pose motion = Pose::Identity();
  motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  motion.translation() = target_mean - motion.linear() * source_mean;
  return motion;
}

}  // namespace planum
