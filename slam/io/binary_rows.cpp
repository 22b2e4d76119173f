#include "slam/io/binary_rows.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>

namespace planum {

static_assert(std::endian::native == std::endian::little,
              "values are written as they are in memory");

void write_rows(AtomicFile& file, std::size_t count, const std::vector<RowPart>& parts) {
  constexpr std::size_t block_bytes = 1 << 19;
  std::size_t row_bytes = 0;
  for (const RowPart& part : parts) row_bytes += part.bytes;
  const std::size_t rows_per_block = block_bytes / row_bytes;
  std::vector<char> block(rows_per_block * row_bytes);
  for (std::size_t first = 0; first < count; first += rows_per_block) {
    const std::size_t rows = std::min(rows_per_block, count - first);
    char* column = block.data();
    for (const RowPart& part : parts) {
      const char* from = static_cast<const char*>(part.values) + first * part.bytes;
      for (std::size_t i = 0; i < rows; ++i)
        std::memcpy(column + i * row_bytes, from + i * part.bytes, part.bytes);
      column += part.bytes;
    }
    file.write(std::string_view(block.data(), rows * row_bytes));
  }
}

}  // namespace planum
