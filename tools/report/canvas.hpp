#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "slam/io/ply.hpp"

namespace planum {

/// How a line is drawn.
struct Stroke {
  Colour colour = {0, 0, 0};
  double width = 1;    ///< pixels
  double opacity = 1;  ///< how much of what is below it covers
};

/// A picture to draw on with smooth edges; x to the right, y down, in pixels.
class Canvas {
 public:
  Canvas(int width, int height, Colour background = {255, 255, 255});

  int width() const { return width_; }
  int height() const { return height_; }

  /// Mixes a colour into one pixel; places outside the picture are passed over.
  void blend(int x, int y, const Colour& colour, double opacity);

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Stroke& stroke);
  void polyline(const std::vector<Eigen::Vector2d>& points, bool closed, const Stroke& stroke);
  void disc(const Eigen::Vector2d& centre, double radius, const Colour& colour);

  /// Inside by the even-odd rule, over all rings.
  void fill(const std::vector<std::vector<Eigen::Vector2d>>& rings, const Colour& colour,
            double opacity);

  /// Words around a point, in the height of a high letter (pixels).
  void text(const Eigen::Vector2d& middle, std::string_view words, double letter_height,
            const Stroke& stroke);
  static double text_width(std::string_view words, double letter_height);

  /// Writes an 8-bit RGB PNG. Throws Error (environment) if the file cannot be written.
  void write_png(const std::filesystem::path& path) const;

 private:
  int width_, height_;
  std::vector<Eigen::Array3f> pixels_;  ///< rows from the top, 0 to 255
};

}  // namespace planum
