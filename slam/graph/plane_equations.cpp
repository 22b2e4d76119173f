#include "slam/graph/plane_equations.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "slam/core/parallel.hpp"
#include "slam/graph/edge_relaxation.hpp"
#include "slam/graph/pose_graph.hpp"

namespace planum {
namespace {

constexpr std::size_t planes_per_block = 64;

/// Sums of an observation over its points q = rotation (p_world - centre).
PointMoments seen_from(const PlaneObservation& observation, const Pose& world_from_scan,
                       const Eigen::Matrix3d& rotation, const Eigen::Vector3d& centre) {
  const Eigen::Matrix3d turn = rotation * world_from_scan.linear();
  const Eigen::Vector3d shift = rotation * (world_from_scan * observation.origin - centre);
  const PointMoments& m = observation.moments;
  const Eigen::Vector3d turned = turn * m.sum;
  const Eigen::Matrix3d mixed = turned * shift.transpose();
  PointMoments result;
  result.count = m.count;
  result.sum = turned + m.count * shift;
  result.squares = turn * m.squares * turn.transpose() + mixed + mixed.transpose() +
                   m.count * shift * shift.transpose();
  return result;
}

/// A plane linearized. In its frame a point is (a, b, h), h off the plane; a motion x of its scan
/// moves it by (1, a, b) J x along the normal. With K the sum of (1, a, b)' (1, a, b) over the
/// points of a scan, g that of h (1, a, b), and y what the plane itself moves, the sum of squares
/// is that of (J x - y)' K (J x - y) + 2 g' (J x - y). Least over y, what is left between scans s
/// and t is -J' K_s (sum of K)^-1 K_t J.
struct LinearPlane {
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix3d eliminated = Eigen::Matrix3d::Zero();  ///< inverse of the sum of K
  double count = 0;
  std::vector<Eigen::Matrix3d> squares;   ///< K of each observation
  std::vector<Eigen::Vector3d> gradient;  ///< g of each observation
};

LinearPlane linearized(const SharedPlane& plane, std::span<const Pose> poses) {
  LinearPlane result;
  result.squares.assign(plane.size(), Eigen::Matrix3d::Zero());
  result.gradient.assign(plane.size(), Eigen::Vector3d::Zero());
  const std::optional<PlaneFit> fit = fitted(plane, poses);
  if (!fit) return result;
  const Eigen::Vector3d n = fit->plane.normal, u = fit->axes.col(2), v = n.cross(u);
  Eigen::Matrix3d plane_from_world;
  plane_from_world << u.transpose(), v.transpose(), n.transpose();
  result.jacobian.row(0) << n.transpose(), fit->centroid.cross(n).transpose();
  result.jacobian.row(1).tail<3>() = u.cross(n);
  result.jacobian.row(2).tail<3>() = v.cross(n);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < plane.size(); ++k) {
    const PointMoments m =
        seen_from(plane[k], poses[plane[k].scan], plane_from_world, fit->centroid);
    Eigen::Matrix3d& squares = result.squares[k];
    squares << m.count, m.sum[0], m.sum[1],          //
        m.sum[0], m.squares(0, 0), m.squares(0, 1),  //
        m.sum[1], m.squares(1, 0), m.squares(1, 1);
    result.gradient[k] << m.sum[2], m.squares(0, 2), m.squares(1, 2);
    sum += squares;
    result.count += m.count;
  }
  result.eliminated = sum.inverse();
  return result;
}

}  // namespace

std::optional<PlaneFit> fitted(const SharedPlane& plane, std::span<const Pose> world_from_scan) {
  if (plane.empty()) return std::nullopt;
  // Relative to somewhere near: squares of large numbers cancel badly.
  const Eigen::Vector3d near = world_from_scan[plane.front().scan] * plane.front().origin;
  PointMoments moments;
  for (const PlaneObservation& observation : plane)
    moments += seen_from(observation, world_from_scan[observation.scan],
                         Eigen::Matrix3d::Identity(), near);
  std::optional<PlaneFit> fit = fit_plane(moments);
  if (!fit) return fit;
  fit->centroid += near;
  fit->plane.offset = fit->plane.normal.dot(fit->centroid);
  return fit;
}

double squared_distances(std::span<const SharedPlane> planes,
                         std::span<const Pose> world_from_scan) {
  double sum = 0;
  for (const SharedPlane& plane : planes) {
    const std::optional<PlaneFit> fit = fitted(plane, world_from_scan);
    if (!fit) continue;
    for (const PlaneObservation& observation : plane)
      sum += fit->variances[0] * observation.moments.count;
  }
  return sum;
}

PlaneSystem::PlaneSystem(std::span<const SharedPlane> planes, std::size_t poses)
    : seen_(poses),
      fixed_(poses),
      cholesky_(std::make_shared<FrontTree>(analyzed_fronts(0, {})), 6) {
  for (std::uint32_t p = 0; p < planes.size(); ++p)
    for (std::uint32_t k = 0; k < planes[p].size(); ++k)
      seen_[planes[p][k].scan].emplace_back(p, k);
  std::vector<std::size_t> seen_with(poses, poses);  // the last pose that this one was noted for
  for (std::size_t i = 0; i < poses; ++i) {
    first_pair_.push_back(pairs_.size());
    for (const auto& [p, k] : seen_[i])
      for (std::size_t other = k + 1; other < planes[p].size(); ++other) {
        const std::size_t j = planes[p][other].scan;
        if (std::exchange(seen_with[j], i) != i) pairs_.emplace_back(i, j);
      }
    std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(first_pair_.back()), pairs_.end());
  }
  first_pair_.push_back(pairs_.size());
  std::vector<std::pair<std::size_t, std::size_t>> connected(pairs_.begin(), pairs_.end());
  const std::vector<std::size_t> first = first_connected(poses, connected);
  for (std::size_t i = 0; i < poses; ++i) fixed_[i] = first[i] == i;
  cholesky_ = BlockCholesky(std::make_shared<FrontTree>(analyzed_fronts(poses, pairs_)), 6);
}

void PlaneSystem::linearize(std::span<const SharedPlane> planes,
                            const std::vector<Pose>& world_from_scan,
                            const std::vector<Pose>& prior, std::span<const double> radius,
                            double stiffness) {
  std::vector<LinearPlane> linear(planes.size());
  parallel_for(planes.size(), planes_per_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) linear[p] = linearized(planes[p], world_from_scan);
  });
  matrix_ = cholesky_.matrix();
  gradient_ = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(seen_.size()));
  shared_.assign(pairs_.size(), 0);
  // Each pose fills its own row of blocks.
  parallel_for(seen_.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<std::size_t> pair_with(seen_.size());
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = first_pair_[i]; k < first_pair_[i + 1]; ++k)
        pair_with[pairs_[k].second] = k;
      auto diagonal = matrix_.diagonal_block<Matrix6d>(i);
      for (const auto& [p, own] : seen_[i]) {
        const LinearPlane& plane = linear[p];
        if (plane.count <= 0) continue;
        const Eigen::Matrix<double, 6, 3> lever = plane.jacobian.transpose();
        const Eigen::Matrix3d& squares = plane.squares[own];
        const Eigen::Matrix3d half = squares * plane.eliminated;
        gradient_.segment<6>(6 * static_cast<Eigen::Index>(i)) += lever * plane.gradient[own];
        diagonal += lever * (squares - half * squares) * lever.transpose();
        const Eigen::Matrix<double, 6, 3> row = lever * half;
        for (std::size_t other = own + 1; other < planes[p].size(); ++other) {
          const std::size_t k = pair_with[planes[p][other].scan];
          matrix_.off_diagonal_block<Matrix6d>(k).noalias() -=
              row * (plane.squares[other] * plane.jacobian);
          shared_[k] += squares(0, 0) * plane.squares[other](0, 0) / plane.count;
        }
      }
    }
  });
  add_prior(world_from_scan, prior, radius, stiffness);
}

void PlaneSystem::add_prior(const std::vector<Pose>& poses, const std::vector<Pose>& prior,
                            std::span<const double> radius, double stiffness) {
  if (stiffness <= 0) return;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto [i, j] = pairs_[k];
    // Half about either scan, so that their order does not matter.
    const double weight = stiffness * shared_[k] / 2;
    const Vector6d information = both_parts(weight, weight * radius[i] * radius[j]);
    for (const auto& [from, to] : {std::pair(i, j), std::pair(j, i)}) {
      const Edge edge{.from = from, .to = to, .from_from_to = prior[from].inverse() * prior[to]};
      const LinkEquation equation = edge_equation(edge, Matrix6d(information.asDiagonal()), poses);
      matrix_.diagonal_block<Matrix6d>(i) += equation.information;
      matrix_.diagonal_block<Matrix6d>(j) += equation.information;
      matrix_.off_diagonal_block<Matrix6d>(k) -= equation.information;
      gradient_.segment<6>(6 * static_cast<Eigen::Index>(to)) -= equation.weighted_difference;
      gradient_.segment<6>(6 * static_cast<Eigen::Index>(from)) += equation.weighted_difference;
    }
  }
}

Eigen::MatrixXd PlaneSystem::dense_hessian() const {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(gradient_.size(), gradient_.size());
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const auto at = 6 * static_cast<Eigen::Index>(i);
    dense.block<6, 6>(at, at) = matrix_.diagonal_block<Matrix6d>(i);
  }
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const auto i = 6 * static_cast<Eigen::Index>(pairs_[k].first);
    const auto j = 6 * static_cast<Eigen::Index>(pairs_[k].second);
    dense.block<6, 6>(i, j) = matrix_.off_diagonal_block<Matrix6d>(k);
    dense.block<6, 6>(j, i) = dense.block<6, 6>(i, j).transpose();
  }
  return dense;
}

std::optional<std::vector<Vector6d>> PlaneSystem::solved() {
  BlockMatrix matrix = matrix_;
  Eigen::VectorXd right = -gradient_;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    if (fixed_[i]) {
      matrix.diagonal_block<Matrix6d>(i).setIdentity();
      right.segment<6>(6 * static_cast<Eigen::Index>(i)).setZero();
    }
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (fixed_[pairs_[k].first] || fixed_[pairs_[k].second])
      matrix.off_diagonal_block<Matrix6d>(k).setZero();
  if (!cholesky_.factorize(matrix)) return std::nullopt;
  const Eigen::VectorXd solution = cholesky_.solve(right);
  std::vector<Vector6d> motions;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    motions.push_back(solution.segment<6>(6 * static_cast<Eigen::Index>(i)));
  return motions;
}

}  // namespace planum
