#pragma once

#include <filesystem>

namespace planum {

/// Keeps other runs out of an output directory as long as it lives. The lock is held on the open
/// file (flock), so that it ends with the process however that ends.
class RunLock {
 public:
  /// Throws Error(environment) naming the other process if there is one.
  explicit RunLock(const std::filesystem::path& file);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace planum
