#include "slam/io/uos.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/point_lines.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

/// The axes of this project in terms of those of UOS; a mirroring, for UOS is left-handed.
Eigen::Matrix3d planum_from_uos_axes() {
  return (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, 1, 0).finished();
}

/// `N x M`: the size of the scan, as some 3DTK tools put it into the first line.
bool is_size_line(std::string_view line) {
  const std::size_t cross = line.find(" x ");
  if (cross == std::string_view::npos) return false;
  const auto is_count = [](std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return is_count(line.substr(0, cross)) && is_count(line.substr(cross + 3));
}

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Angles x, y, z with R = Rx Ry Rz. Where y is a right angle, x and z turn about the same axis:
/// then z = 0.
Eigen::Vector3d euler_xyz(const Eigen::Matrix3d& r) {
  const double cos_y = std::hypot(r(0, 0), r(0, 1));
  const double y = std::atan2(r(0, 2), cos_y);
  if (cos_y < 1e-12) return {std::atan2(r(2, 1), r(1, 1)), y, 0};
  return {std::atan2(-r(1, 2), r(2, 2)), y, std::atan2(-r(0, 1), r(0, 0))};
}

}  // namespace

Pose pose_from_uos(const Eigen::Vector3d& position, const Eigen::Vector3d& angles) {
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.topLeftCorner<3, 3>() = rotation_about(Eigen::Vector3d::UnitX(), radians(angles.x())) *
                                    rotation_about(Eigen::Vector3d::UnitY(), radians(angles.y())) *
                                    rotation_about(Eigen::Vector3d::UnitZ(), radians(angles.z()));
  transform.topRightCorner<3, 1>() = position;
  return pose_from_uos(transform);
}

Pose pose_from_uos(const Eigen::Matrix4d& transform) {
  const Eigen::Matrix3d axes = planum_from_uos_axes();
  Pose pose = Pose::Identity();
  pose.linear() = axes * transform.topLeftCorner<3, 3>() * axes.transpose();
  pose.translation() = axes * transform.topRightCorner<3, 1>() / 100;
  return pose;
}

Eigen::Matrix4d uos_from_pose(const Pose& pose) {
  const Eigen::Matrix3d axes = planum_from_uos_axes();
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.topLeftCorner<3, 3>() = axes.transpose() * pose.linear() * axes;
  transform.topRightCorner<3, 1>() = 100 * (axes.transpose() * pose.translation());
  return transform;
}

Cloud read_uos_scan(const std::filesystem::path& path) {
  TextReader reader(path);
  bool more = reader.next_data_line();
  if (more && is_size_line(reader.line())) more = reader.next_data_line();
  if (!more) throw Error(path.string() + ": there are no points in it");
  return read_point_lines(
      reader,
      {.point =
           [](double right, double up, double forward) {
             return Eigen::Vector3d(forward / 100, -right / 100, up / 100).cast<float>().eval();
           },
       .has_intensity = [](std::size_t columns) { return columns >= 4; }});
}

void write_uos_scan(const std::filesystem::path& path, const Cloud& cloud) {
  const bool with_intensity = cloud.intensity.size() == cloud.points.size();
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d p = 100 * cloud.points[i].cast<double>();
    // Nine digits give the same float back.
    fmt::format_to(std::back_inserter(text), "{:.9g} {:.9g} {:.9g}", -p.y(), p.z(), p.x());
    if (with_intensity) fmt::format_to(std::back_inserter(text), " {}", cloud.intensity[i]);
    text.push_back('\n');
  }
  write_file_atomically(path, {text.data(), text.size()});
}

Pose read_uos_pose(const std::filesystem::path& path) {
  TextReader reader(path);
  std::array<double, 6> values;
  std::size_t count = 0;
  while (reader.next_data_line()) {
    count += reader.numbers(std::span(values).subspan(count));
    if (!reader.word().empty()) reader.fail("expected 6 numbers in all, but there are more");
  }
  if (count < values.size())
    reader.fail(fmt::format(
        "expected 6 numbers (x y z in cm, three angles in degrees), but the file ends after {}",
        count));
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    reader.fail("expected finite numbers");
  return pose_from_uos({values[0], values[1], values[2]}, {values[3], values[4], values[5]});
}

void write_uos_pose(const std::filesystem::path& path, const Pose& world_from_scan) {
  const Eigen::Matrix4d transform = uos_from_pose(world_from_scan);
  const Eigen::Vector3d t = transform.topRightCorner<3, 1>();
  const Eigen::Vector3d angles = euler_xyz(transform.topLeftCorner<3, 3>());
  write_file_atomically(
      path, fmt::format("{} {} {}\n{} {} {}\n", t.x(), t.y(), t.z(), degrees(angles.x()),
                        degrees(angles.y()), degrees(angles.z())));
}

}  // namespace planum
