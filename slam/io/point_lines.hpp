#pragma once

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {

/// How a text format with one point a line writes its points.
struct PointLines {
  /// The first three numbers of a line as a point in metres, in the frame of this project.
  Eigen::Vector3f (*point)(double first, double second, double third);
  /// Whether the fourth of so many columns is the intensity.
  bool (*has_intensity)(std::size_t columns);
};

/// Reads points from the reader's current line to the end of the file. The first line decides
/// whether there are intensities. Throws Error for a line with fewer numbers.
Cloud read_point_lines(TextReader& reader, const PointLines& format);

}  // namespace planum
