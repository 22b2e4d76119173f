#include "slam/io/pose_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

/// Yaw, pitch, roll with R = Rz Ry Rx. Where the pitch is a right angle, yaw and roll turn about
/// the same axis: then roll = 0.
Eigen::Vector3d yaw_pitch_roll(const Eigen::Matrix3d& r) {
  const double cos_pitch = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), cos_pitch);
  if (cos_pitch < 1e-12) return {std::atan2(-r(0, 1), r(1, 1)), pitch, 0};
  return {std::atan2(r(1, 0), r(0, 0)), pitch, std::atan2(r(2, 1), r(2, 2))};
}

}  // namespace

std::vector<Pose> read_pose_list(const std::filesystem::path& path) {
  TextReader reader(path);
  std::vector<Pose> poses;
  std::array<double, 6> n;
  while (reader.next_data_line()) {
    reader.all_numbers(n, "x y z yaw pitch roll");
    if (!std::all_of(n.begin(), n.end(), [](double v) { return std::isfinite(v); }))
      reader.fail("expected finite numbers");
    poses.push_back(
        pose_from_xyz_ypr({n[0], n[1], n[2]}, radians(n[3]), radians(n[4]), radians(n[5])));
  }
  if (poses.empty()) throw Error(path.string() + ": there are no poses in it");
  return poses;
}

void write_pose_list(const std::filesystem::path& path, std::span<const Pose> poses) {
  std::string text = "# x y z yaw pitch roll (m, degrees)\n";
  for (const Pose& pose : poses) {
    const Eigen::Vector3d t = pose.translation();
    const Eigen::Vector3d angles = yaw_pitch_roll(pose.linear());
    text += fmt::format("{} {} {} {} {} {}\n", t.x(), t.y(), t.z(), degrees(angles[0]),
                        degrees(angles[1]), degrees(angles[2]));
  }
  write_file_atomically(path, text);
}

}  // namespace planum
