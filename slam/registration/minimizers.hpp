#pragma once

#include <span>

#include "slam/core/pose.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

/// Ways to the rigid motion that takes the sources of pairs nearest to their targets in the least
/// squares sense. The first four give it at once; the others solve a linear problem that is right
/// for small turns, and are there when the motion they give no longer changes anything.
enum class Minimizer {
  svd,              ///< singular values (Arun, Huang & Blostein 1987; Umeyama 1991)
  quaternion,       ///< largest eigenvector of a 4 x 4 matrix (Horn 1987)
  dual_quaternion,  ///< turn and shift together (Walker, Shao & Volz 1991)
  orthonormal,      ///< square root of a matrix (Horn, Hilden & Negahdaripour 1988)
  helix,            ///< a velocity field, followed as a screw (Pottmann, Leopoldseder & Hofer 2002)
  small_angle,      ///< sin a = a, cos a = 1 about the means
  lu_milios,        ///< the midpoints of pairs as places (Lu & Milios 1997; Borrmann et al. 2008)
};

/// The motion of the sources; of the last three minimizers, one step of it. Where the pairs leave a
/// direction open, the smallest motion in it, or some minimum. Never mirrors. Identity without
/// pairs.
Pose rigid_motion(std::span<const Pair> pairs, Minimizer minimizer = Minimizer::svd);

}  // namespace planum
