#include "meshing/curvature.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace planum {

CurvatureFit::CurvatureFit(const Plane& plane, const Eigen::Vector3d& origin)
    : plane_(plane), frame_(plane), origin_(origin) {}

void CurvatureFit::add(const Eigen::Vector3d& point, double weight) {
  const Eigen::Vector2d flat = frame_.flat(point - origin_);
  const double x = flat.x(), y = flat.y();
  Eigen::Matrix<double, 6, 1> row;
  row << 1, x, y, x * x, x * y, y * y;
  squares_.noalias() += weight * row * row.transpose();
  heights_ += weight * plane_.signed_distance(point) * row;
}

double CurvatureFit::curvature() const {
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver(squares_);
  if (solver.info() != Eigen::Success || solver.rcond() < 1e-14) return 0;
  const Eigen::Matrix<double, 6, 1> q = solver.solve(heights_);
  if (!q.allFinite()) return 0;
  return std::abs(q[3] + q[5]) + std::hypot(q[3] - q[5], q[4]);
}

}  // namespace planum
