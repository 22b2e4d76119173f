#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/input_file.hpp"
#include "slam/io/ply_rows.hpp"

namespace planum {
namespace {

constexpr std::size_t block_bytes = 1 << 19;  // stays in the cache while its columns are taken out

template <class Value>
Value value_at(const char* bytes, bool swapped) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Value));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Value>(raw);
}

/// Calls f with a zero of the type that `type` stands for.
template <class Function>
auto with_type(PlyType type, const Function& f) {
  switch (type) {
    case PlyType::int8:
      return f(std::int8_t{});
    case PlyType::uint8:
      return f(std::uint8_t{});
    case PlyType::int16:
      return f(std::int16_t{});
    case PlyType::uint16:
      return f(std::uint16_t{});
    case PlyType::int32:
      return f(std::int32_t{});
    case PlyType::uint32:
      return f(std::uint32_t{});
    case PlyType::float32:
      return f(float{});
    case PlyType::float64:
      break;
  }
  return f(double{});
}

class BinaryRows : public PlyRows {
 public:
  BinaryRows(const std::filesystem::path& path, const PlyHeader& header)
      : file_(path),
        swapped_((header.encoding == PlyEncoding::big_endian) ==
                 (std::endian::native == std::endian::little)),
        bytes_left_(file_.size() - std::min<std::uint64_t>(header.bytes, file_.size())) {
    file_.seek(header.bytes);
  }

  void check_size(const PlyElement& element) const override {
    const std::size_t row = element.smallest_row();
    if (row > 0 && element.count > (bytes_left_ + end_ - at_) / row) fail_too_short(element);
  }

  void read(const PlyElement& element, const PlyRequest& request) override {
    check_size(element);
    if (element.properties.empty()) return;
    if (element.has_lists())
      read_rows(element, request);
    else
      read_blocks(element, request);
  }

 private:
  [[noreturn]] void fail_too_short(const PlyElement& element) const {
    throw Error(fmt::format("{}: the file is too short for {} rows of {}", file_.path().string(),
                            element.count, element.name));
  }

  [[noreturn]] void fail_no_index(const PlyElement& element, double value) const {
    throw Error(fmt::format("{}: expected an index in element {}, got {}", file_.path().string(),
                            element.name, value));
  }

  /// The next `count` bytes of the file; they stay where they are until the next call.
  const char* take(std::uint64_t count, const PlyElement& element) {
    if (count > end_ - at_) refill(count, element);
    const char* const bytes = buffer_.data() + at_;
    at_ += count;
    return bytes;
  }

  void refill(std::uint64_t count, const PlyElement& element) {
    const std::size_t kept = end_ - at_;
    if (count - kept > bytes_left_) fail_too_short(element);
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(at_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    buffer_.resize(std::max<std::size_t>({buffer_.size(), block_bytes, count}));
    const std::size_t got = file_.read(std::span(buffer_).subspan(kept));
    bytes_left_ -= std::min<std::uint64_t>(got, bytes_left_);
    at_ = 0;
    end_ = kept + got;
    if (end_ < count) fail_too_short(element);
  }

  double number_at(const char* bytes, PlyType type) const {
    return with_type(type, [&](auto zero) {
      return static_cast<double>(value_at<decltype(zero)>(bytes, swapped_));
    });
  }

  /// Takes `rows` values that are `step` bytes apart into the rows of a column from `first` on.
  void copy_column(const char* bytes, PlyType type, std::size_t step, std::size_t rows,
                   std::size_t first, const PlyColumn& column, const PlyElement& element) const {
    with_type(type, [&](auto zero) {
      using Value = decltype(zero);
      if (column.floats)
        copy_floats<Value>(bytes, step, rows, column.floats + first * column.stride, column.stride);
      else
        copy_indices<Value>(bytes, step, rows, column.indices + first * column.stride,
                            column.stride, element);
    });
  }

  template <class Value>
  void copy_floats(const char* bytes, std::size_t step, std::size_t rows, float* to,
                   std::size_t stride) const {
    if (swapped_)
      for (std::size_t i = 0; i < rows; ++i)
        to[i * stride] = static_cast<float>(value_at<Value>(bytes + i * step, true));
    else
      for (std::size_t i = 0; i < rows; ++i)
        to[i * stride] = static_cast<float>(value_at<Value>(bytes + i * step, false));
  }

  template <class Value>
  void copy_indices(const char* bytes, std::size_t step, std::size_t rows, std::uint32_t* to,
                    std::size_t stride, const PlyElement& element) const {
    for (std::size_t i = 0; i < rows; ++i)
      to[i * stride] = index_from(value_at<Value>(bytes + i * step, swapped_), element);
  }

  template <class Value>
  std::uint32_t index_from(Value value, const PlyElement& element) const {
    if constexpr (std::is_unsigned_v<Value>) return value;
    const std::optional<std::uint32_t> index = ply_index(static_cast<double>(value));
    if (!index) fail_no_index(element, static_cast<double>(value));
    return *index;
  }

  /// Rows of the same length: many at a time, column by column.
  void read_blocks(const PlyElement& element, const PlyRequest& request) {
    const std::size_t row_bytes = element.smallest_row();
    const std::size_t rows_per_block = std::max<std::size_t>(block_bytes / row_bytes, 1);
    for (std::size_t first = 0; first < element.count; first += rows_per_block) {
      const std::size_t rows = std::min<std::size_t>(rows_per_block, element.count - first);
      const char* bytes = take(rows * row_bytes, element);
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyType type = element.properties[p].type;
        if (const PlyColumn* column = find_column(request, p))
          copy_column(bytes, type, row_bytes, rows, first, *column, element);
        bytes += size_of(type);
      }
    }
  }

  /// Rows with lists: value by value.
  void read_rows(const PlyElement& element, const PlyRequest& request) {
    for (std::size_t row = 0; row < element.count; ++row) {
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        if (property.count_type) {
          read_list(element, request, p);
          continue;
        }
        const char* bytes = take(size_of(property.type), element);
        if (const PlyColumn* column = find_column(request, p))
          copy_column(bytes, property.type, 0, 1, row, *column, element);
      }
    }
  }

  void read_list(const PlyElement& element, const PlyRequest& request, std::size_t p) {
    const PlyProperty& property = element.properties[p];
    const double length =
        number_at(take(size_of(*property.count_type), element), *property.count_type);
    const std::optional<std::uint32_t> count = ply_index(length);
    if (!count) fail_no_index(element, length);
    const std::size_t value_bytes = size_of(property.type);
    const char* bytes = take(*count * value_bytes, element);
    if (!request.list || request.list_property != p) return;
    list_.resize(*count);
    with_type(property.type, [&](auto zero) {
      copy_indices<decltype(zero)>(bytes, value_bytes, *count, list_.data(), 1, element);
    });
    request.list(list_);
  }

  InputFile file_;
  bool swapped_;
  std::uint64_t bytes_left_;  ///< in the file behind the buffer
  std::vector<char> buffer_;
  std::size_t at_ = 0;   ///< where in the buffer the next bytes are
  std::size_t end_ = 0;  ///< behind the last bytes in the buffer
  std::vector<std::uint32_t> list_;
};

}  // namespace

std::unique_ptr<PlyRows> open_ply_binary(const std::filesystem::path& path,
                                         const PlyHeader& header) {
  return std::make_unique<BinaryRows>(path, header);
}

}  // namespace planum
