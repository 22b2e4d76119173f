#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "slam/core/pose.hpp"

namespace planum {

/// The rigid b_from_a (no scale) with the least sum of squared distances between b_from_a * a[i]
/// and b[i] (Umeyama, PAMI 1991). Empty if the points leave a rotation open: fewer than three, all
/// in one place, or on a line to a hundredth of their extent along it: then small errors across the
/// line turn everything about it.
std::optional<Pose> umeyama_alignment(std::span<const Eigen::Vector3d> a,
                                      std::span<const Eigen::Vector3d> b);

/// The same with orientations: adds lever^2 (m^2) times the sum of squared differences of rotation
/// matrices (Frobenius, halved), so that every trajectory has one answer, a single pose too.
/// Identity for none.
Pose joint_alignment(std::span<const Pose> a, std::span<const Pose> b, double lever);

}  // namespace planum
