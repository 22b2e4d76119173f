#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>

namespace planum {

/// A file that is read from front to back. Throws Error with the path and the system's reason: of
/// kind input if there is no such file or it is a directory, else of kind environment.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Fills `bytes` and returns how many it got: fewer than asked for only at the end of the file.
  std::size_t read(std::span<char> bytes);

  /// The next read starts this many bytes from the beginning.
  void seek(std::uint64_t offset);

  /// Bytes in the file when it was opened; 0 for pipes and devices.
  std::uint64_t size() const { return size_; }

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// The first max_bytes of a file. Throws like InputFile.
std::string read_file(const std::filesystem::path& path,
                      std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace planum
