#include "tools/workflow/run_lock.hpp"

#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {

RunLock::RunLock(const std::filesystem::path& file)
    : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_ < 0) {
    throw Error(fmt::format("{}: cannot open: {}", file.string(), std::strerror(errno)),
                ErrorKind::environment);
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const bool taken = errno == EWOULDBLOCK;
    const std::string reason = std::strerror(errno);
    char holder[32] = {};
    const auto got = pread(descriptor_, holder, sizeof holder - 1, 0);
    close(descriptor_);
    const std::string process = got > 0 ? fmt::format(" (process {})", holder) : "";
    throw Error(taken ? fmt::format("another run{} is working in {}; wait until it has ended",
                                    process, file.parent_path().parent_path().string())
                      : fmt::format("{}: cannot lock: {}", file.string(), reason),
                ErrorKind::environment);
  }
  // The number is only for the message above; the lock does not depend on it.
  const std::string process = std::to_string(getpid());
  if (ftruncate(descriptor_, 0) == 0) {
    [[maybe_unused]] const auto written = pwrite(descriptor_, process.data(), process.size(), 0);
  }
}

RunLock::~RunLock() { close(descriptor_); }

}  // namespace planum
