#include "slam/io/vtk.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

std::string in_capitals(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

/// `# vtk DataFile Version 3.0`, a title, ASCII.
void read_head(TextReader& reader) {
  if (!reader.next_line() || in_capitals(reader.line()).rfind("# VTK DATAFILE", 0) != 0)
    throw Error(reader.path().string() +
                ": not a legacy VTK file: it does not begin with \"# vtk DataFile Version\"");
  reader.next_line();
  if (!reader.next_line()) reader.fail("the file ends before ASCII or BINARY");
  const std::string encoding = in_capitals(reader.word());
  if (encoding == "BINARY")
    reader.fail("binary VTK files are not read; save it as ASCII, or as .ply");
  if (encoding != "ASCII") reader.fail("expected ASCII, got " + in_quotes(encoding));
}

/// Goes to the line `POINTS n type` and returns n.
std::size_t number_of_points(TextReader& reader) {
  while (reader.next_line()) {
    if (in_capitals(reader.word()) != "POINTS") continue;
    const long long count = reader.integer();
    if (count < 0) reader.fail(fmt::format("there cannot be {} points", count));
    return static_cast<std::size_t>(count);
  }
  throw Error(reader.path().string() + ": there is no line POINTS in it");
}

}  // namespace

Cloud read_vtk(const std::filesystem::path& path) {
  TextReader reader(path);
  read_head(reader);
  const std::size_t count = number_of_points(reader);
  Cloud cloud;
  std::vector<float> values;
  while (values.size() < 3 * count) {
    if (!reader.next_data_line())
      throw Error(fmt::format("{}: it is to have {} points, but ends in point {}", path.string(),
                              count, values.size() / 3 + 1));
    reader.append_numbers(values);
  }
  if (values.size() > 3 * count)
    reader.fail(fmt::format("more numbers than the {} points need", count));
  if (count == 0) throw Error(path.string() + ": there are no points in it");
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    cloud.points.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  return cloud;
}

}  // namespace planum
