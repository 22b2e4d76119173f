#include "meshing/plane_meeting.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace planum {
namespace {

/// Of the sum of n n^T; two planes at an angle a have the eigenvalues 1 - cos a and 1 + cos a.
constexpr double min_eigenvalue = 0.0015;  // 3 degrees

}  // namespace

std::optional<PlaneMeeting> meeting(std::span<const Plane> planes, const Eigen::Vector3d& start,
                                    double max_move, double max_offset) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const Plane& plane : planes) {
    matrix.noalias() += plane.normal * plane.normal.transpose();
    right_side -= plane.signed_distance(start) * plane.normal;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  PlaneMeeting result{start, 0};
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] < min_eigenvalue) continue;
    const Eigen::Vector3d axis = solver.eigenvectors().col(k);
    result.point += axis.dot(right_side) / solver.eigenvalues()[k] * axis;
    ++result.rank;
  }
  if (!((result.point - start).norm() <= max_move)) return std::nullopt;
  for (const Plane& plane : planes)
    if (std::abs(plane.signed_distance(result.point)) > max_offset) return std::nullopt;
  return result;
}

bool meet_in_a_line(const Plane& a, const Plane& b) {
  return 1 - std::abs(a.normal.dot(b.normal)) >= min_eigenvalue;
}

}  // namespace planum
