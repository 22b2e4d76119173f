#include "slam/io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names = {{
    {"char", PlyType::int8},
    {"int8", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},
    {"short", PlyType::int16},
    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"uint16", PlyType::uint16},
    {"int", PlyType::int32},
    {"int32", PlyType::int32},
    {"uint", PlyType::uint32},
    {"uint32", PlyType::uint32},
    {"float", PlyType::float32},
    {"float32", PlyType::float32},
    {"double", PlyType::float64},
    {"float64", PlyType::float64},
}};

PlyType type_named(std::string_view word, const TextReader& reader) {
  for (const auto& [name, type] : type_names)
    if (name == word) return type;
  reader.fail(fmt::format("expected a type such as float or uchar, got {}", in_quotes(word)));
}

PlyEncoding read_encoding(TextReader& reader) {
  const std::string_view word = reader.word();
  if (word == "ascii") return PlyEncoding::ascii;
  if (word == "binary_little_endian") return PlyEncoding::little_endian;
  if (word == "binary_big_endian") return PlyEncoding::big_endian;
  reader.fail(fmt::format("expected ascii, binary_little_endian or binary_big_endian, got {}",
                          in_quotes(word)));
}

PlyElement read_element(TextReader& reader) {
  PlyElement element;
  element.name = reader.word();
  const long long count = reader.integer();
  if (count < 0) reader.fail(fmt::format("there cannot be {} rows of {}", count, element.name));
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

PlyProperty read_property(TextReader& reader) {
  PlyProperty property;
  const std::string_view word = reader.word();
  if (word == "list") {
    property.count_type = type_named(reader.word(), reader);
    property.type = type_named(reader.word(), reader);
  } else {
    property.type = type_named(word, reader);
  }
  property.name = reader.word();
  if (property.name.empty()) reader.fail("expected the name of the property");
  return property;
}

/// The header's text: up to the end of the line `end_header`.
std::string header_text(const std::filesystem::path& path) {
  constexpr std::size_t longest_header = 1 << 20;
  constexpr std::string_view last_line = "\nend_header";
  // Most headers are short: read more only for the others.
  for (std::size_t bytes = 1 << 13; bytes <= longest_header; bytes *= 8) {
    std::string text = read_file(path, bytes);
    if (!text.starts_with("ply"))
      throw Error(path.string() + ":1: expected a PLY file, which begins with \"ply\"");
    const std::size_t end = text.find(last_line);
    const std::size_t newline =
        end == std::string::npos ? end : text.find('\n', end + last_line.size());
    if (newline != std::string::npos) {
      text.resize(newline + 1);
      return text;
    }
  }
  throw Error(path.string() + ": the header of the PLY file has no end_header line");
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

std::optional<std::size_t> PlyElement::property(std::string_view property_name) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property_name) return i;
  return std::nullopt;
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.count_type.has_value(); });
}

std::size_t PlyElement::smallest_row() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.count_type.value_or(property.type));
  return bytes;
}

PlyHeader read_ply_header(const std::filesystem::path& path) {
  const std::string text = header_text(path);
  TextReader reader(path, text);
  PlyHeader header;
  header.bytes = text.size();
  bool has_format = false;
  reader.next_line();
  if (reader.rest() != "ply") reader.fail("expected \"ply\"");
  while (reader.next_line()) {
    const std::string_view keyword = reader.word();
    if (keyword == "format") {
      header.encoding = read_encoding(reader);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(reader));
    } else if (keyword == "property") {
      if (header.elements.empty()) reader.fail("expected an element before its properties");
      header.elements.back().properties.push_back(read_property(reader));
    } else if (keyword != "comment" && keyword != "obj_info" && keyword != "end_header") {
      reader.fail(
          fmt::format("expected element, property or end_header, got {}", in_quotes(keyword)));
    }
  }
  if (!has_format) reader.fail("the header has no format line");
  header.lines = reader.line_number();
  return header;
}

}  // namespace planum
