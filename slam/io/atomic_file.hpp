#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string_view>

namespace planum {

/// A file that appears under its name only when it is complete: it is written as `.NAME.part`
/// beside it and renamed by commit(). Until then an earlier file of that name stays as it is;
/// without a commit nothing is left behind. The directory must exist. A symbolic link is followed;
/// what is not a regular file is not overwritten, and a second writer of the same name is turned
/// away. Every failure is an Error of kind environment with the path, the reason and what to do.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Goes straight to the system: write large blocks.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// A buffered stream into the file; its failures are thrown as Error too.
  std::ostream& stream();

  /// Brings all bytes to the disk and puts the file under its name. Nothing may be written after
  /// it.
  void commit();

 private:
  class Implementation;
  std::unique_ptr<Implementation> file_;
};

/// Writes a whole file by way of AtomicFile.
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace planum
