#include "tools/maps/label_textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <png.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/ply.hpp"

namespace planum {
namespace {

constexpr std::size_t shades = 16;

/// In [0, 1), the same for the same numbers.
double random_of(int a, int b, int seed) {
  auto n = static_cast<std::uint32_t>(a) * 0x9E3779B1u +
           static_cast<std::uint32_t>(b) * 0x85EBCA77u +
           static_cast<std::uint32_t>(seed) * 0xC2B2AE3Du;
  n = (n ^ (n >> 15)) * 0x2C1B3C6Du;
  n = (n ^ (n >> 12)) * 0x297A2D39u;
  return (n ^ (n >> 15)) / 4294967296.0;
}

/// Smooth noise in [0, 1) with `columns` x `rows` hills in a picture, which fits onto itself.
double noise(double u, double v, int columns, int rows, int seed) {
  const double x = u * columns, y = v * rows;
  const int i = static_cast<int>(std::floor(x)), k = static_cast<int>(std::floor(y));
  const auto at = [&](int column, int row) {
    return random_of((column % columns + columns) % columns, (row % rows + rows) % rows, seed);
  };
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double s = smooth(x - i), t = smooth(y - k);
  return std::lerp(std::lerp(at(i, k), at(i + 1, k), s),
                   std::lerp(at(i, k + 1), at(i + 1, k + 1), s), t);
}

/// From 1 on a line at the ends of [0, 1] to 0 at `width` from it.
double near_edge(double t, double width) { return std::max(0.0, 1 - std::min(t, 1 - t) / width); }

/// Boards along u with a joint each, the grain along them.
double boards(double u, double v, int rows, int seed) {
  const int row = static_cast<int>(std::floor(v * rows));
  const double across = v * rows - row;
  const double along = u + random_of(row, 1, seed);
  const double shade = random_of(row, 2, seed);
  const double grain = 0.6 * noise(u + shade, v, 3, 12 * rows, seed) +
                       0.4 * noise(u, v + shade, 8, 24 * rows, seed + 1);
  const double joint = near_edge(along - std::floor(along), 0.006);
  return (0.25 + 0.35 * shade + 0.4 * grain) *
         (1 - 0.8 * std::max(joint, near_edge(across, 0.006 * rows)));
}

double plaster(double u, double v) {
  return 0.25 + 0.3 * noise(u, v, 5, 5, 11) + 0.3 * noise(u, v, 14, 14, 12) +
         0.15 * noise(u, v, 48, 48, 13);
}

/// One panel of a hung ceiling with the rails around it.
double panel(double u, double v) {
  const double rail = std::max(near_edge(u, 0.03), near_edge(v, 0.03));
  const double holes = noise(u, v, 40, 40, 21) > 0.86 ? 0.25 : 0;
  return rail > 0 ? 0.15 + 0.3 * (1 - rail) : 0.9 - holes;
}

double stone(double u, double v) {
  return 0.2 + 0.3 * noise(u, v, 6, 6, 31) + 0.5 * noise(u, v, 56, 56, 32);
}

/// Slanting reflections.
double glass(double u, double v) {
  const double wave = 0.5 + 0.5 * std::sin(2 * pi * (u + v));
  const double narrow = 0.5 + 0.5 * std::sin(2 * pi * (3 * u + 3 * v) + 1);
  return 0.15 + 0.55 * wave * wave + 0.3 * wave * narrow;
}

/// Faint crossing stripes: nobody knows what it is.
double hatched(double u, double v) {
  return 0.5 + 0.25 * std::sin(2 * pi * 4 * (u + v)) + 0.25 * std::sin(2 * pi * 4 * (u - v));
}

struct Recipe {
  double size;  // m
  int pixels;
  Colour dark, light;
  double (*shade)(double u, double v);  // in [0, 1]; u to the right, v up, both in [0, 1)
};

Recipe recipe_of(Label label) {
  switch (label) {
    case Label::floor:
      return {1.2, 256, {96, 62, 34}, {214, 168, 112}, [](double u, double v) {
                return boards(u, v, 8, 1);
              }};
    case Label::ceiling:
      return {0.6, 128, {168, 172, 176}, {250, 250, 248}, panel};
    case Label::wall:
      return {1.0, 128, {206, 198, 180}, {244, 240, 230}, plaster};
    case Label::door:
      return {1.0, 128, {70, 30, 14}, {172, 92, 52}, [](double u, double v) {
                return boards(v, u, 6, 2);
              }};
    case Label::window:
      return {1.0, 128, {96, 152, 196}, {226, 242, 250}, glass};
    case Label::stair:
      return {0.5, 128, {84, 86, 92}, {178, 178, 176}, stone};
    case Label::furniture_horizontal:
      return {1.0, 128, {160, 128, 80}, {238, 214, 168}, [](double u, double v) {
                return boards(u, v, 4, 3);
              }};
    case Label::furniture_vertical:
      return {1.0, 128, {112, 84, 50}, {196, 158, 108}, [](double u, double v) {
                return boards(v, u, 4, 4);
              }};
    case Label::unknown:
      break;
  }
  return {0.5, 128, {112, 112, 116}, {150, 150, 152}, hatched};
}

/// Shades from dark to light.
std::array<Colour, shades> palette(const Colour& dark, const Colour& light) {
  std::array<Colour, shades> result;
  for (std::size_t i = 0; i < shades; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = (light[k] - dark[k]) / (shades - 1.0);
      result[i][k] = static_cast<std::uint8_t>(std::lround(dark[k] + step * i));
    }
  return result;
}

std::string encoded(const std::vector<std::uint8_t>& indices, int pixels,
                    const std::array<Colour, shades>& colours) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = static_cast<png_uint_32>(pixels);
  image.format = PNG_FORMAT_RGB_COLORMAP;
  image.colormap_entries = shades;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(bytes, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &bytes, 0, indices.data(), 0, colours.data()))
    throw Error(std::string("texture: ") + image.message);
  file.resize(bytes);
  return file;
}

}  // namespace

std::string texture_png(Label label) {
  const Recipe recipe = recipe_of(label);
  std::vector<std::uint8_t> indices;
  for (int y = 0; y < recipe.pixels; ++y)
    for (int x = 0; x < recipe.pixels; ++x) {
      const double shade =
          recipe.shade((x + 0.5) / recipe.pixels, 1 - (y + 0.5) / recipe.pixels) * shades;
      indices.push_back(static_cast<std::uint8_t>(std::clamp(shade, 0.0, shades - 0.5)));
    }
  return encoded(indices, recipe.pixels, palette(recipe.dark, recipe.light));
}

double texture_size(Label label) { return recipe_of(label).size; }

}  // namespace planum
