#include "slam/io/point_lines.hpp"

#include <array>

#include <fmt/format.h>

namespace planum {
namespace {

std::size_t words_of(std::string_view line) {
  std::size_t count = 0;
  bool in_word = false;
  for (const char c : line) {
    const bool space = c == ' ' || c == '\t';
    if (!space && !in_word) {
      if (c == '#') break;
      ++count;
    }
    in_word = !space;
  }
  return count;
}

}  // namespace

Cloud read_point_lines(TextReader& reader, const PointLines& format) {
  const bool with_intensity = format.has_intensity(words_of(reader.line()));
  const std::size_t first_line = reader.line_number();
  std::array<double, 4> numbers;
  const std::span<double> wanted(numbers.data(), with_intensity ? 4 : 3);
  Cloud cloud;
  do {
    const std::size_t count = reader.numbers(wanted);
    if (count < 3) reader.fail(fmt::format("expected 3 numbers, got {}", count));
    if (count < wanted.size())
      reader.fail(fmt::format("expected 4 numbers as in line {}, got {}", first_line, count));
    cloud.points.push_back(format.point(numbers[0], numbers[1], numbers[2]));
    if (with_intensity) cloud.intensity.push_back(static_cast<float>(numbers[3]));
  } while (reader.next_data_line());
  return cloud;
}

}  // namespace planum
