#include "slam/core/plane.hpp"

#include <Eigen/Eigenvalues>

namespace planum {

Plane facing(const Plane& plane, const Eigen::Vector3d& direction) {
  const double side = plane.normal.dot(direction) < 0 ? -1 : 1;
  return {side * plane.normal, side * plane.offset};
}

void PointMoments::add(const Eigen::Vector3d& p, double weight) {
  count += weight;
  sum += weight * p;
  squares.noalias() += weight * p * p.transpose();
}

PointMoments& PointMoments::operator+=(const PointMoments& other) {
  count += other.count;
  sum += other.sum;
  squares += other.squares;
  return *this;
}

Eigen::Matrix3d PointMoments::covariance() const {
  const Eigen::Vector3d mean = centroid();
  return squares / count - mean * mean.transpose();
}

std::optional<PlaneFit> fit_plane(const PointMoments& moments) {
  if (moments.count < 3) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.covariance());
  const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(0);
  // Collinear: the second principal axis has no extent beyond rounding.
  if (variances[1] <= 1e-12 * variances[2] || variances[2] <= 0) return std::nullopt;
  PlaneFit fit;
  fit.centroid = moments.centroid();
  fit.plane.normal = solver.eigenvectors().col(0);
  fit.plane.offset = fit.plane.normal.dot(fit.centroid);
  fit.variances = variances;
  fit.axes = solver.eigenvectors();
  return fit;
}

std::optional<PlaneFit> fit_plane(std::span<const Eigen::Vector3d> points) {
  if (points.size() < 3) return std::nullopt;
  const Eigen::Vector3d origin = points.front();
  PointMoments moments;
  for (const Eigen::Vector3d& p : points) moments.add(p - origin);
  std::optional<PlaneFit> fit = fit_plane(moments);
  if (fit) {
    fit->centroid += origin;
    fit->plane.offset = fit->plane.normal.dot(fit->centroid);
  }
  return fit;
}

}  // namespace planum
