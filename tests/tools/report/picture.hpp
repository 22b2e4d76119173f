#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include "slam/io/ply.hpp"

namespace planum::testing {

/// A picture that was read.
struct Picture {
  int width = 0, height = 0;
  std::vector<Colour> pixels;  ///< rows from the top

  const Colour& at(int x, int y) const {
    return pixels.at(static_cast<std::size_t>(y * width + x));
  }
};

/// Any PNG file, by libpng; the test fails if it is none, or if it is not of the format.
inline Picture read_png(const std::filesystem::path& path, png_uint_32 format = PNG_FORMAT_RGB) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  Picture picture;
  if (png_image_begin_read_from_file(&image, path.c_str())) {
    EXPECT_EQ(image.format, format) << "by default 8 bits of red, green and blue";
    image.format = PNG_FORMAT_RGB;
    picture.width = static_cast<int>(image.width);
    picture.height = static_cast<int>(image.height);
    picture.pixels.resize(static_cast<std::size_t>(image.width) * image.height);
    png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr);
  }
  EXPECT_EQ(image.warning_or_error, 0u) << path << ": " << image.message;
  return picture;
}

/// How much darker than white a pixel is, in [0, 1], in one channel.
inline double ink(const Colour& colour, std::size_t channel = 0) {
  return (255 - colour[channel]) / 255.0;
}

/// The sum of ink over the whole picture: the area (pixels) that black covers.
inline double total_ink(const Picture& picture) {
  double sum = 0;
  for (const Colour& pixel : picture.pixels) sum += ink(pixel);
  return sum;
}

}  // namespace planum::testing
