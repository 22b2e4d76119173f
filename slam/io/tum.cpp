#include "slam/io/tum.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/pose_text.hpp"

namespace planum {

Trajectory read_tum(const std::filesystem::path& path) {
  TextReader reader(path);
  Trajectory trajectory;
  std::array<double, 8> numbers;
  while (reader.next_data_line()) {
    reader.all_numbers(numbers, "stamp x y z qx qy qz qw");
    if (!std::isfinite(numbers[0])) reader.fail("expected a finite stamp");
    trajectory.push_back({.stamp = numbers[0],
                          .pose = pose_from_quaternion(std::span(numbers).subspan<1>(), reader)});
  }
  if (trajectory.empty()) throw Error(path.string() + ": there are no poses in it");
  return trajectory;
}

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory) {
  std::string text;
  for (const StampedPose& pose : trajectory)
    text += fmt::format("{} {}\n", pose.stamp, quaternion_text(pose.pose));
  write_file_atomically(path, text);
}

}  // namespace planum
