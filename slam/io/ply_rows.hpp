#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "slam/io/ply_header.hpp"

namespace planum {

/// Where a scalar property goes: to one of the two, `stride` values from row to row.
struct PlyColumn {
  std::size_t property = 0;
  float* floats = nullptr;
  std::uint32_t* indices = nullptr;
  std::size_t stride = 1;
};

/// What a reader of an element wants of it; the rest is passed over.
struct PlyRequest {
  std::vector<PlyColumn> columns;
  std::size_t list_property = 0;
  /// Gets the list property of each row, as indices; none if empty.
  std::function<void(std::span<const std::uint32_t>)> list;
};

/// The data of a PLY file behind its header, element by element in the order of the header.
class PlyRows {
 public:
  virtual ~PlyRows() = default;

  /// Throws Error if the file is too short for the rows of the next element, so that no memory is
  /// taken for them in vain.
  virtual void check_size(const PlyElement& element) const = 0;

  /// Reads the next element. Throws Error if the file ends early, or if an index is none.
  virtual void read(const PlyElement& element, const PlyRequest& request) = 0;
};

/// Opens the data of a PLY file of any encoding.
std::unique_ptr<PlyRows> open_ply_rows(const std::filesystem::path& path, const PlyHeader& header);
std::unique_ptr<PlyRows> open_ply_text(const std::filesystem::path& path, const PlyHeader& header);
std::unique_ptr<PlyRows> open_ply_binary(const std::filesystem::path& path,
                                         const PlyHeader& header);

/// The index that a number is: whole, from 0 to 2^32 - 1.
std::optional<std::uint32_t> ply_index(double value);

/// The column that a property goes to, if one was asked for.
const PlyColumn* find_column(const PlyRequest& request, std::size_t property);

}  // namespace planum
