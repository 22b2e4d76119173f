#include "slam/io/xyz.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/point_lines.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {

Cloud read_xyz(const std::filesystem::path& path) {
  TextReader reader(path);
  if (!reader.next_data_line()) throw Error(path.string() + ": there are no points in it");
  return read_point_lines(
      reader, {.point = [](double x, double y,
                           double z) { return Eigen::Vector3d(x, y, z).cast<float>().eval(); },
               .has_intensity = [](std::size_t columns) { return columns == 4 || columns == 7; }});
}

void write_xyz(const std::filesystem::path& path, const Cloud& cloud) {
  const bool with_intensity = cloud.intensity.size() == cloud.points.size();
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    fmt::format_to(std::back_inserter(text), "{} {} {}", p.x(), p.y(), p.z());
    if (with_intensity) fmt::format_to(std::back_inserter(text), " {}", cloud.intensity[i]);
    text.push_back('\n');
  }
  write_file_atomically(path, {text.data(), text.size()});
}

}  // namespace planum
