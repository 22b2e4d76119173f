#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "tools/workflow/digest.hpp"

namespace planum {

/// Digests of file contents. A file that was read before is not read again as long as its size,
/// time of change and inode are the same; that memory is kept in a small JSON file. Any number of
/// threads may ask.
class FileDigests {
 public:
  /// Starts from what `memory` holds; a missing or damaged file is an empty memory.
  explicit FileDigests(std::filesystem::path memory);

  /// The digest of the content of a file; throws Error if it cannot be read.
  Digest of(const std::filesystem::path& path);

  /// The same, but a missing file has the digest of zeros.
  Digest of_if_there(const std::filesystem::path& path);

  /// Writes the memory, without the entries of files that are gone.
  void save() const;

 private:
  struct Entry {
    std::uintmax_t size = 0;
    std::int64_t changed_ns = 0;
    std::uint64_t inode = 0;
    Digest digest;
  };

  std::filesystem::path memory_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace planum
