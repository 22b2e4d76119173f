#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace planum {

/// The scalar types of PLY.
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in a binary file.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  ///< of the length, if the property is a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The position of a property, if it is there.
  std::optional<std::size_t> property(std::string_view property_name) const;
  bool has_lists() const;
  /// Bytes of one row in a binary file, its lists empty.
  std::size_t smallest_row() const;
};

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;  ///< up to and with `end_header`
  std::size_t bytes = 0;  ///< where the data begins
};

/// Reads the header of a PLY file. Throws Error `path:line` if it is none.
PlyHeader read_ply_header(const std::filesystem::path& path);

}  // namespace planum
