#include "slam/io/ply_rows.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/text_reader.hpp"

namespace planum {
namespace {

class TextRows : public PlyRows {
 public:
  TextRows(const std::filesystem::path& path, std::size_t header_lines)
      : reader_(path), bytes_(std::filesystem::file_size(path)) {
    while (reader_.line_number() < header_lines && reader_.next_line()) {
    }
  }

  void check_size(const PlyElement& element) const override {
    const std::uint64_t shortest_row = 2 * element.properties.size();  // a digit and a space each
    if (shortest_row > 0 && element.count > bytes_ / shortest_row + 1)
      reader_.fail(
          fmt::format("the file is too short for {} rows of {}", element.count, element.name));
  }

  void read(const PlyElement& element, const PlyRequest& request) override {
    if (element.properties.empty()) return;
    for (std::size_t row = 0; row < element.count; ++row) {
      if (!reader_.next_data_line())
        reader_.fail(
            fmt::format("expected {} rows of {}, got {}", element.count, element.name, row));
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        if (element.properties[p].count_type)
          read_list(request, p);
        else
          store(find_column(request, p), row, reader_.number());
      }
    }
  }

 private:
  std::uint32_t index(double value) const {
    const std::optional<std::uint32_t> result = ply_index(value);
    if (!result) reader_.fail(fmt::format("expected an index, got {}", value));
    return *result;
  }

  void store(const PlyColumn* column, std::size_t row, double value) const {
    if (!column) return;
    if (column->floats)
      column->floats[row * column->stride] = static_cast<float>(value);
    else
      column->indices[row * column->stride] = index(value);
  }

  void read_list(const PlyRequest& request, std::size_t property) {
    const bool wanted = request.list && request.list_property == property;
    const std::uint32_t count = index(reader_.number());
    list_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const double value = reader_.number();
      if (wanted) list_.push_back(index(value));
    }
    if (wanted) request.list(list_);
  }

  TextReader reader_;
  std::uint64_t bytes_;
  std::vector<std::uint32_t> list_;
};

}  // namespace

std::unique_ptr<PlyRows> open_ply_text(const std::filesystem::path& path, const PlyHeader& header) {
  return std::make_unique<TextRows>(path, header.lines);
}

std::unique_ptr<PlyRows> open_ply_rows(const std::filesystem::path& path, const PlyHeader& header) {
  return header.encoding == PlyEncoding::ascii ? open_ply_text(path, header)
                                               : open_ply_binary(path, header);
}

std::optional<std::uint32_t> ply_index(double value) {
  const bool in_range = value >= 0 && value <= std::numeric_limits<std::uint32_t>::max();
  if (!in_range || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

const PlyColumn* find_column(const PlyRequest& request, std::size_t property) {
  for (const PlyColumn& column : request.columns)
    if (column.property == property) return &column;
  return nullptr;
}

}  // namespace planum
