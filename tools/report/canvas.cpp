#include "tools/report/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include <png.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/report/stroke_font.hpp"

namespace planum {
namespace {

constexpr double letter_advance = 5.5;  // units of the font's grid from letter to letter
constexpr double letter_units = 6;      // of a high letter

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
              Eigen::Array3f(background[0], background[1], background[2])) {}

void Canvas::blend(int x, int y, const Colour& colour, double opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_ || opacity <= 0) return;
  const auto cover = static_cast<float>(std::min(opacity, 1.0));
  Eigen::Array3f& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                  static_cast<std::size_t>(x)];
  pixel += cover * (Eigen::Array3f(colour[0], colour[1], colour[2]) - pixel);
}

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Stroke& stroke) {
  polyline({from, to}, false, stroke);
}

void Canvas::polyline(const std::vector<Eigen::Vector2d>& points, bool closed,
                      const Stroke& stroke) {
  const double reach = stroke.width / 2 + 1;
  const Eigen::Array2d size(width_, height_);
  const std::size_t segments = points.size() - (closed || points.empty() ? 0 : 1);
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::Vector2d &a = points[i], &b = points[(i + 1) % points.size()];
    // Clamped before they become int: lines may end anywhere.
    const Eigen::Array2d low = (a.cwiseMin(b).array() - reach).floor().max(0).min(size);
    const Eigen::Array2d high = (a.cwiseMax(b).array() + reach).ceil().min(size - 1);
    for (int y = static_cast<int>(low.y()); y <= high.y(); ++y) {
      for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
        const double distance = distance_to_segment({x + 0.5, y + 0.5}, a, b);
        const double cover = std::clamp(stroke.width / 2 + 0.5 - distance, 0.0, 1.0);
        blend(x, y, stroke.colour, cover * stroke.opacity);
      }
    }
  }
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius, const Colour& colour) {
  line(centre, centre, {.colour = colour, .width = 2 * radius});
}

void Canvas::fill(const std::vector<std::vector<Eigen::Vector2d>>& rings, const Colour& colour,
                  double opacity) {
  std::vector<double> crossings;
  for (int y = 0; y < height_; ++y) {
    crossings.clear();
    const double at = y + 0.5;
    for (const auto& ring : rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
        if ((a.y() > at) == (b.y() > at)) continue;
        crossings.push_back(a.x() + (at - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
      }
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double left = std::clamp<double>(crossings[i], 0, width_);
      const double right = std::min<double>(crossings[i + 1], width_);
      for (int x = static_cast<int>(left); x < right; ++x) {
        const double cover = std::min(right, x + 1.0) - std::max<double>(left, x);
        blend(x, y, colour, cover * opacity);
      }
    }
  }
}

double Canvas::text_width(std::string_view words, double letter_height) {
  const double units = letter_advance * static_cast<double>(words.size()) - 1.5;
  return std::max(units, 0.0) * letter_height / letter_units;
}

void Canvas::text(const Eigen::Vector2d& middle, std::string_view words, double letter_height,
                  const Stroke& stroke) {
  const double scale = letter_height / letter_units;
  const Eigen::Vector2d corner =
      middle + Eigen::Vector2d(-text_width(words, letter_height) / 2, letter_height / 2);
  double left = 0;
  for (const char letter : words) {
    std::vector<Eigen::Vector2d> points;
    const auto draw = [&] {
      polyline(points, false, stroke);
      points.clear();
    };
    const std::string_view strokes = strokes_of(letter);
    for (std::size_t i = 0; i < strokes.size(); i += strokes[i] == ' ' ? 1 : 2) {
      if (strokes[i] == ' ')
        draw();
      else
        points.push_back(corner + scale * Eigen::Vector2d(left + strokes[i] - '0',
                                                          2.0 - (strokes[i + 1] - '0')));
    }
    draw();
    left += letter_advance;
  }
}

void Canvas::write_png(const std::filesystem::path& path) const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * pixels_.size());
  for (const Eigen::Array3f& pixel : pixels_)
    for (const float value : pixel) bytes.push_back(static_cast<std::uint8_t>(std::lround(value)));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width_);
  image.height = static_cast<png_uint_32>(height_);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::vector<std::byte> encoded;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, bytes.data(), 0, nullptr)) {
    encoded.resize(size);
    png_image_write_to_memory(&image, encoded.data(), &size, 0, bytes.data(), 0, nullptr);
  }
  if (image.warning_or_error != 0)
    throw Error(path.string() + ": the picture cannot be encoded: " + image.message,
                ErrorKind::environment);
  AtomicFile file(path);
  file.write(std::span<const std::byte>(encoded).first(size));
  file.commit();
}

}  // namespace planum
