#include "tools/workflow/file_digests.hpp"

#include <cstring>
#include <fstream>
#include <sys/stat.h>
#include <time.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

constexpr std::int64_t nanoseconds = 1'000'000'000;

std::int64_t in_nanoseconds(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * nanoseconds + time.tv_nsec;
}

std::int64_t now() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return in_nanoseconds(time);
}

}  // namespace

FileDigests::FileDigests(std::filesystem::path memory) : memory_(std::move(memory)) {
  std::ifstream stream(memory_);
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) return;
  try {
    for (const auto& [path, value] : json.items()) {
      entries_[path] = {value.at(0), value.at(1), value.at(2),
                        digest_from_string(value.at(3).get<std::string>())};
    }
  } catch (const std::exception&) {
    entries_.clear();  // damaged: every file is read again
  }
}

Digest FileDigests::of(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    throw Error(fmt::format("{}: {}", path.string(), std::strerror(errno)));
  }
  Entry entry{static_cast<std::uintmax_t>(status.st_size),
              in_nanoseconds(status.st_mtim),
              status.st_ino,
              {}};
  {
    const std::lock_guard guard(mutex_);
    const auto known = entries_.find(path.string());
    if (known != entries_.end() && known->second.size == entry.size &&
        known->second.changed_ns == entry.changed_ns && known->second.inode == entry.inode) {
      return known->second.digest;
    }
  }
  const bool settled = now() - entry.changed_ns > nanoseconds;
  entry.digest = digest_of_file(path);
  // A file changed within the last second may change again without a new time stamp.
  if (settled) {
    const std::lock_guard guard(mutex_);
    entries_[path.string()] = entry;
  }
  return entry.digest;
}

Digest FileDigests::of_if_there(const std::filesystem::path& path) {
  return std::filesystem::is_regular_file(path) ? of(path) : Digest{};
}

void FileDigests::save() const {
  nlohmann::json json = nlohmann::json::object();
  const std::lock_guard guard(mutex_);
  for (const auto& [path, entry] : entries_) {
    if (!std::filesystem::exists(path)) continue;
    json[path] = {entry.size, entry.changed_ns, entry.inode, to_string(entry.digest)};
  }
  write_file_atomically(memory_, json.dump(1) + "\n");
}

}  // namespace planum
