#include "slam/io/frames.hpp"

#include <array>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/text_reader.hpp"
#include "slam/io/uos.hpp"

namespace planum {

void write_frames(const std::filesystem::path& path, std::span<const Frame> frames) {
  std::string text;
  for (const Frame& frame : frames) {
    const Eigen::Matrix4d transform = uos_from_pose(frame.world_from_scan);
    for (const double value : transform.reshaped()) text += fmt::format("{} ", value);
    text += fmt::format("{}\n", static_cast<int>(frame.kind));
  }
  write_file_atomically(path, text);
}

std::vector<Frame> read_frames(const std::filesystem::path& path) {
  TextReader reader(path);
  std::vector<Frame> frames;
  std::array<double, 17> values;
  while (reader.next_data_line()) {
    reader.all_numbers(values, "a 4 x 4 matrix by columns and the kind of frame");
    const Eigen::Matrix4d transform = Eigen::Map<const Eigen::Matrix4d>(values.data());
    if (!transform.topLeftCorner<3, 3>().isUnitary(1e-3) ||
        !(transform.topLeftCorner<3, 3>().determinant() > 0) || !transform.allFinite())
      reader.fail("the matrix is not a rigid transform");
    if (!(values[16] >= 0 && values[16] <= 1000)) reader.fail("the kind of frame is not 0, 1, ...");
    frames.push_back({orthonormalized(pose_from_uos(transform)), FrameKind(int(values[16]))});
  }
  if (frames.empty()) throw Error(path.string() + ": there are no frames in it");
  return frames;
}

}  // namespace planum
