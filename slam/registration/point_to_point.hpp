#pragma once

#include <span>

#include "slam/core/pose.hpp"
#include "slam/registration/pairing.hpp"

namespace planum {

/// The rigid motion that takes the sources of pairs nearest to their targets in the least squares
/// sense, in closed form by a singular value decomposition (Arun, Huang & Blostein 1987; Umeyama
/// 1991 for the reflection case). Where the pairs leave a rotation undetermined, some minimum.
/// Identity without pairs.
Pose closed_form_motion(std::span<const Pair> pairs);

}  // namespace planum
