#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "slam/core/pose.hpp"

namespace planum {

/// What a link says about the small motions of its two poses: X_a - X_b is near `difference`, with
/// information C^-1. Given as C^-1 and C^-1 * difference, which exist where C does not.
struct LinkEquation {
  std::size_t a = 0, b = 0;  ///< different poses
  Matrix6d information = Matrix6d::Zero();
  Vector6d weighted_difference = Vector6d::Zero();
};

/// The linear system G X = B of Lu & Milios (1997) in 6D (Borrmann et al. 2008): G_ii is the sum of
/// C^-1 over the links of i, G_ij = -C_ij^-1, B_i the sum of +-C^-1 D. Solved by CHOLMOD; the fill
/// reducing order and the symbolic factorization are found once for all systems of one set of
/// links.
class LuMiliosSystem {
 public:
  /// A pair of poses for each link, and for each pose whether it may not move. Throws Error if a
  /// pose is out of range or linked with itself.
  LuMiliosSystem(std::span<const std::pair<std::size_t, std::size_t>> links,
                 std::vector<bool> fixed);
  ~LuMiliosSystem();
  LuMiliosSystem(const LuMiliosSystem&) = delete;
  LuMiliosSystem& operator=(const LuMiliosSystem&) = delete;

  /// The motions X of all poses, zero for the fixed ones. `links` as they were given to the
  /// constructor, in the same order. `damping` (one value each for [translation, rotation] of every
  /// pose) keeps poses in place that no link determines. Throws Error if the system is not positive
  /// definite even so.
  std::vector<Vector6d> solve(std::span<const LinkEquation> links, const Vector6d& damping);

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace planum
