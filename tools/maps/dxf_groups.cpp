#include "tools/maps/dxf_groups.hpp"

#include <iterator>

#include <fmt/format.h>

namespace planum::dxf {

void append(std::string& text, int code, const std::string& value) {
  fmt::format_to(std::back_inserter(text), "{:3}\n{}\n", code, value);
}

void append(std::string& text, int code, const char* value) {
  append(text, code, std::string(value));
}

void append(std::string& text, int code, int value) { append(text, code, fmt::to_string(value)); }

void append(std::string& text, int code, double value) {
  append(text, code, fmt::format("{:.6f}", value));
}

void append_handle(std::string& text, int code, unsigned handle) {
  append(text, code, fmt::format("{:X}", handle));
}

void append_point(std::string& text, const Eigen::Vector2d& p, int first_code) {
  append(text, first_code, p.x());
  append(text, first_code + 10, p.y());
}

void append_point_in_space(std::string& text, const Eigen::Vector2d& p, int first_code) {
  append_point(text, p, first_code);
  append(text, first_code + 20, 0.0);
}

std::string in_ascii(const std::string& words) {
  std::string result;
  for (std::size_t i = 0; i < words.size();) {
    const auto first = static_cast<unsigned char>(words[i]);
    const std::size_t more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
    if (more == 0 || i + more >= words.size()) {
      result += first >= 0x20 && first < 0x7F ? words[i] : '?';
      ++i;
      continue;
    }
    unsigned code = first & (0x3Fu >> more);
    for (std::size_t k = 1; k <= more; ++k)
      code = (code << 6) | (static_cast<unsigned char>(words[i + k]) & 0x3Fu);
    result += code <= 0xFFFF ? fmt::format("\\U+{:04X}", code) : "?";
    i += more + 1;
  }
  return result;
}

}  // namespace planum::dxf
