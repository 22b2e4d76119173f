#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/plane.hpp"
#include "slam/core/pose.hpp"
#include "slam/graph/block_cholesky.hpp"

namespace planum {

/// What one scan sees of a plane: sums over its weighted points, relative to `origin`.
struct PlaneObservation {
  std::size_t scan = 0;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, scanner frame
  PointMoments moments;
};

/// A plane that scans share; each scan once, ascending.
using SharedPlane = std::vector<PlaneObservation>;

/// The plane nearest to all its points; empty if they are a line.
std::optional<PlaneFit> fitted(const SharedPlane& plane, std::span<const Pose> world_from_scan);

/// m^2, sum over all planes of the squared distances of their points to the best plane: count times
/// the least eigenvalue of the covariance.
double squared_distances(std::span<const SharedPlane> planes,
                         std::span<const Pose> world_from_scan);

/// Least squares of the points' distances to their planes over small motions X <- exp_se3(x) X of
/// all poses, with the planes eliminated: Gauss-Newton for the sum of least eigenvalues of Ferrer
/// (Eigen-factors, IROS 2019) and Liu & Zhang (BALM, RA-L 2021).
class PlaneSystem {
 public:
  /// The pattern of the planes; `poses` is how many there are.
  PlaneSystem(std::span<const SharedPlane> planes, std::size_t poses);

  /// Puts the equations of the planes in. Where two scans share planes, their relative pose is held
  /// at that of `prior` by `stiffness` times what the planes hold along a direction that all their
  /// normals have. `radius` (m, of each scan) is the lever of rotations.
  void linearize(std::span<const SharedPlane> planes, const std::vector<Pose>& world_from_scan,
                 const std::vector<Pose>& prior, std::span<const double> radius, double stiffness);

  /// Half the derivative of squared_distances() by the motions (and of the prior's part).
  const Eigen::VectorXd& gradient() const { return gradient_; }

  /// The same by the motions twice, where the points are on the planes.
  Eigen::MatrixXd dense_hessian() const;

  /// The motions of all poses; the first of whatever shares planes is fixed. Empty if the equations
  /// do not determine the others.
  std::optional<std::vector<Vector6d>> solved();

 private:
  void add_prior(const std::vector<Pose>& poses, const std::vector<Pose>& prior,
                 std::span<const double> radius, double stiffness);

  std::vector<BlockPair> pairs_;
  std::vector<std::size_t> first_pair_;  ///< of each pose as the lower one of a pair
  std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>
      seen_;                    ///< for each pose the planes, and which observation is its own
  std::vector<bool> fixed_;     ///< for each pose
  std::vector<double> shared_;  ///< for each pair: how many points (weights) bind the two
  BlockCholesky cholesky_;
  BlockMatrix matrix_;
  Eigen::VectorXd gradient_;
};

}  // namespace planum
