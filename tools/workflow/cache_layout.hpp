#pragma once

#include <filesystem>
#include <string>

namespace planum {

/// Where the workflow keeps its own files, below the output directory.
struct CacheLayout {
  std::filesystem::path output;

  std::filesystem::path root() const { return output / ".cache"; }
  std::filesystem::path lock() const { return root() / "lock"; }
  std::filesystem::path digests() const { return root() / "files.json"; }
  std::filesystem::path staging() const { return root() / "staging"; }
  std::filesystem::path manifest(const std::string& stage) const {
    return root() / stage / "manifest.json";
  }
  /// Finished parts of a stage's work.
  std::filesystem::path units(const std::string& stage) const { return root() / stage / "units"; }
  /// A result that only the workflow reads.
  std::filesystem::path result(const std::string& stage) const {
    return root() / stage / "result.bin";
  }
};

}  // namespace planum
