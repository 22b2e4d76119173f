#pragma once

#include <cstddef>
#include <vector>

#include "slam/io/atomic_file.hpp"

namespace planum {

/// One thing that each row of a binary file has, as it is in memory.
struct RowPart {
  const void* values = nullptr;
  std::size_t bytes = 0;  ///< of one row
};

/// Writes `count` rows of parts, little endian.
void write_rows(AtomicFile& file, std::size_t count, const std::vector<RowPart>& parts);

}  // namespace planum
