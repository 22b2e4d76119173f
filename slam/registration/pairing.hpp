#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "slam/core/pose.hpp"
#include "slam/registration/matching_scan.hpp"

namespace planum {

/// What the distance of a pair is measured to.
enum class Pairing {
  point_to_point,  ///< the nearest point of the target (Besl & McKay 1992)
  point_to_plane,  ///< the local plane of that point (Chen & Medioni 1992)
  plane_to_plane,  ///< as uncertain along both local planes (GICP: Segal, Haehnel & Thrun 2009)
  symmetric,       ///< along the mean of both normals (Rusinkiewicz 2019)
};

/// Which pairs are taken.
struct PairGate {
  double distance = 0;          ///< m, to the nearest target point
  double residual = 0;          ///< m, not for point_to_point; weight 0 is reached here
  double max_normal_angle = 0;  ///< rad, pairs whose surfaces face more apart are dropped
};

/// A source point and what it is matched with, both in the target's frame.
struct Pair {
  Eigen::Vector3d source;  ///< m
  Eigen::Vector3d target;  ///< m, the nearest point, or a point on its local plane
  Eigen::Vector3d normal;  ///< unit, of the local plane; zero in point_to_point where unknown
  double weight = 1;
  double tilt_variance = 0;                                 ///< rad^2, of the normal
  Eigen::Vector3d source_normal = Eigen::Vector3d::Zero();  ///< unit; zero where it does not enter
};

/// The inverse covariance of the distance of a plane_to_plane pair (GICP), scaled so that it is
/// n n^T plus a thousandth of the rest where both normals are n.
Eigen::Matrix3d pair_metric(const Pair& pair);

/// Finds pairs again and again while a source moves towards its target; remembers what each search
/// found, so that the next one is short.
class PairFinder {
 public:
  /// `selection` are positions of source points, best ascending. Both scans must outlive the
  /// finder.
  PairFinder(const MatchingScan& source, const MatchingScan& target,
             std::span<const std::uint32_t> selection);

  /// Looks at other points of the source from now on. Those that stay keep their memory.
  void select(std::span<const std::uint32_t> selection);

  /// Pairs in the order of the selection.
  std::vector<Pair> find(const Pose& target_from_source, Pairing pairing, const PairGate& gate);

  std::size_t selected() const { return seekers_.size(); }

  /// How many pairs there are for each independent one: with point_to_plane a selected point
  /// carries the noise of all the points of its plane, which its neighbours carry too.
  double redundancy(Pairing pairing) const;

 private:
  /// A selected point of the source, in the source's frame.
  struct Seeker {
    std::uint32_t index = 0;   ///< in the source
    Eigen::Vector3f point;     ///< m
    Eigen::Vector3f smoothed;  ///< m, MatchingScan::smoothed
    Eigen::Vector3f normal;    ///< zero: unknown
    float tilt_variance = 0;   ///< rad^2
    SearchMemory memory;
  };

  const MatchingScan* source_;
  const MatchingScan* target_;
  std::vector<Seeker> seekers_;
};

}  // namespace planum
