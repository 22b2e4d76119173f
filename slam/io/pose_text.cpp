#include "slam/io/pose_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace planum {

Pose pose_from_quaternion(std::span<const double, 7> numbers, const TextReader& reader) {
  constexpr double max_length_error = 0.01;
  if (!std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); }))
    reader.fail("expected finite numbers");
  const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (std::abs(rotation.norm() - 1) > max_length_error)
    reader.fail(fmt::format("expected a unit quaternion qx qy qz qw, got one of length {:.3g}",
                            rotation.norm()));
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

std::string quaternion_text(const Pose& pose) {
  Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
  if (q.w() < 0) q.coeffs() *= -1;
  const Eigen::Vector3d t = pose.translation();
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace planum
