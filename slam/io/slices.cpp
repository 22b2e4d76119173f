#include "slam/io/slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

struct HeaderKey {
  std::string_view name;
  double TiltedLaser::*value;
  double unit;  ///< in rad, m or s
};

constexpr std::array header_keys = {
    HeaderKey{"angle_min_rad", &TiltedLaser::first_beam, 1},
    HeaderKey{"first_beam_deg", &TiltedLaser::first_beam, pi / 180},
    HeaderKey{"angle_inc_rad", &TiltedLaser::beam_step, 1},
    HeaderKey{"step_deg", &TiltedLaser::beam_step, pi / 180},
    HeaderKey{"range_min", &TiltedLaser::min_range, 1},
    HeaderKey{"range_max", &TiltedLaser::max_range, 1},
    HeaderKey{"time_inc_s", &TiltedLaser::beam_interval, 1},
    HeaderKey{"mount_x_m", &TiltedLaser::mount_x, 1},
    HeaderKey{"mount_z_m", &TiltedLaser::mount_z, 1},
};
constexpr std::string_view beams_key = "beams";

struct Header {
  TiltedLaser laser;
  std::optional<double> beams;
  bool known_key = false;
};

const HeaderKey* find_key(std::string_view name) {
  const auto found = std::find_if(header_keys.begin(), header_keys.end(),
                                  [&](const HeaderKey& key) { return key.name == name; });
  return found == header_keys.end() ? nullptr : &*found;
}

std::vector<std::string_view> words_of_comment(std::string_view line) {
  constexpr std::string_view separators = " \t#:=";
  std::vector<std::string_view> words;
  std::size_t begin = line.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return words;
}

/// Takes the pairs `key number` of a comment line into the header. A line is prose from the first
/// word on that is neither a known key nor followed by a number.
void read_header_line(const TextReader& reader, Header& header) {
  const std::vector<std::string_view> words = words_of_comment(reader.line());
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const HeaderKey* key = find_key(words[i]);
    const bool known = key || words[i] == beams_key;
    const bool last = i + 1 == words.size();
    const std::optional<double> value = last ? std::nullopt : number_from(words[i + 1]);
    if (!known && !value) return;
    if (!known) continue;
    if (!value || !std::isfinite(*value))
      reader.fail(fmt::format("expected a finite number after {}, got {}", words[i],
                              last ? "the end of the line" : in_quotes(words[i + 1])));
    header.known_key = true;
    if (key)
      header.laser.*key->value = *value * key->unit;
    else
      header.beams = *value;
  }
}

Slice read_slice(TextReader& reader, std::size_t expected_ranges) {
  std::array<double, 2> time_and_tilt;
  const std::size_t count = reader.numbers(time_and_tilt);
  if (count < 2) reader.fail(fmt::format("expected time, tilt and ranges, got {} number", count));
  const auto [time, tilt] = time_and_tilt;
  if (!std::isfinite(time) || !std::isfinite(tilt))
    reader.fail(fmt::format("expected finite time and tilt, got {} and {}", time, tilt));
  Slice slice = {.time = time, .tilt = radians(tilt), .ranges = {}};
  slice.ranges.reserve(expected_ranges);
  reader.append_numbers(slice.ranges);
  return slice;
}

/// Each slice must have as many ranges as the first one, and as many as the header says.
void check_ranges(const TextReader& reader, const Header& header, const RawScan& scan,
                  std::size_t first_line) {
  const std::size_t count = scan.slices.back().ranges.size();
  const std::size_t first_count = scan.slices.front().ranges.size();
  if (count != first_count)
    reader.fail(
        fmt::format("expected {} ranges as in line {}, got {}", first_count, first_line, count));
  if (count < 2)
    reader.fail(fmt::format("expected time, tilt and at least 2 ranges, got {}", count));
  if (header.beams && *header.beams != static_cast<double>(count))
    reader.fail(fmt::format("expected {} ranges as the header says, got {}", *header.beams, count));
}

}  // namespace

RawScan read_slices(const std::filesystem::path& path) {
  TextReader reader(path);
  RawScan scan;
  Header header;
  std::size_t first_line = 0;
  while (reader.next_line()) {
    if (reader.is_comment()) {
      read_header_line(reader, header);
      continue;
    }
    if (scan.slices.empty()) first_line = reader.line_number();
    scan.slices.push_back(
        read_slice(reader, scan.slices.empty() ? 0 : scan.slices.front().ranges.size()));
    check_ranges(reader, header, scan, first_line);
  }
  if (scan.slices.empty()) throw Error(path.string() + ": there are no slices in it");
  scan.laser = header.laser;
  return scan;
}

void write_slices(const std::filesystem::path& path, const RawScan& scan) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const HeaderKey& key : header_keys) {
    const double value = scan.laser.*key.value;
    const bool is_default = value == TiltedLaser().*key.value;
    if (key.unit == 1 && !is_default) fmt::format_to(out, "# {} {}\n", key.name, value);
  }
  const std::size_t beams = scan.slices.empty() ? 0 : scan.slices.front().ranges.size();
  fmt::format_to(out, "# {} {}\n", beams_key, beams);
  for (const Slice& slice : scan.slices) {
    if (slice.ranges.size() != beams)
      throw Error(fmt::format("{}: slices of {} and of {} ranges cannot be one scan", path.string(),
                              beams, slice.ranges.size()));
    fmt::format_to(out, "{} {}", slice.time, degrees(slice.tilt));
    for (const float range : slice.ranges) fmt::format_to(out, " {}", range);
    text.push_back('\n');
  }
  write_file_atomically(path, {text.data(), text.size()});
}

bool looks_like_slices(const std::filesystem::path& path) {
  constexpr std::size_t bytes_to_look_at = 1 << 16;
  // Longer than x y z intensity r g b nx ny nz.
  constexpr std::size_t min_numbers = 12;
  TextReader reader(path, read_file(path, bytes_to_look_at));
  Header header;
  while (reader.next_line()) {
    if (reader.is_comment()) {
      try {
        read_header_line(reader, header);
      } catch (const Error&) {
        return true;  // a known key without its number: reading it will say so
      }
      continue;
    }
    std::array<double, min_numbers> numbers;
    try {
      return header.known_key || reader.numbers(numbers) == min_numbers;
    } catch (const Error&) {
      return false;
    }
  }
  return header.known_key;
}

}  // namespace planum
