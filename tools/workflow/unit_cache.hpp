#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "tools/workflow/digest.hpp"

namespace planum {

/// Results of units of work (a scan, a pair), each in a file that also holds the digest of
/// everything it depends on, so that a run that was killed goes on behind the last finished unit.
/// Any number of threads may use it.
class UnitCache {
 public:
  /// `reuse`: false does everything anew; what was there is found no more.
  explicit UnitCache(std::filesystem::path directory, bool reuse = true);

  /// The stored bytes of a unit, if it was done before with the same key and is undamaged.
  std::optional<std::string> find(const std::string& unit, const Digest& key);

  /// The same, made from whatever.
  std::optional<std::string> read(const std::string& unit) const;

  void store(const std::string& unit, const Digest& key, std::string_view bytes);

  /// Where a unit is kept.
  std::filesystem::path file(const std::string& unit) const;

  /// Removes every unit that was neither found nor stored since construction.
  void remove_unused();

 private:
  std::filesystem::path directory_;
  bool reuse_;
  std::mutex mutex_;
  std::set<std::string> used_;
};

}  // namespace planum
