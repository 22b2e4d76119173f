#pragma once

#include <span>
#include <string>

#include "slam/core/pose.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {

/// The pose `x y z qx qy qz qw` on the reader's line. Throws Error `path:line` if a number is not
/// finite or the quaternion is not of unit length (to 1 %); it is normalized.
Pose pose_from_quaternion(std::span<const double, 7> numbers, const TextReader& reader);

/// `x y z qx qy qz qw`, qw >= 0, each number as short as it can be to come back exactly.
std::string quaternion_text(const Pose& pose);

}  // namespace planum
