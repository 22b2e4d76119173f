#include "tools/workflow/unit_cache.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

constexpr std::size_t header_size = 2 * sizeof(Digest);

std::string key_bytes(const Digest& digest) {
  return {reinterpret_cast<const char*>(digest.words.data()), sizeof digest.words};
}

/// Digests of what the unit depends on and of its bytes.
std::string header(std::string_view key, std::string_view bytes) {
  return std::string(key) + key_bytes(Hasher().bytes(bytes.data(), bytes.size()).result());
}

/// Header and bytes, if they belong together.
std::optional<std::string> read_unit(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::string stored{std::istreambuf_iterator<char>(stream), {}};
  if (stored.size() < header_size) return std::nullopt;
  const std::string_view view = stored;
  if (header(view.substr(0, sizeof(Digest)), view.substr(header_size)) !=
      view.substr(0, header_size)) {
    return std::nullopt;
  }
  return stored;
}

}  // namespace

UnitCache::UnitCache(std::filesystem::path directory, bool reuse)
    : directory_(std::move(directory)), reuse_(reuse) {}

std::filesystem::path UnitCache::file(const std::string& unit) const {
  return directory_ / (unit + ".unit");
}

std::optional<std::string> UnitCache::read(const std::string& unit) const {
  const auto stored = read_unit(file(unit));
  if (!stored) return std::nullopt;
  return stored->substr(header_size);
}

std::optional<std::string> UnitCache::find(const std::string& unit, const Digest& key) {
  if (!reuse_) return std::nullopt;
  auto stored = read_unit(file(unit));
  if (!stored || key_bytes(key) != std::string_view(*stored).substr(0, sizeof(Digest))) {
    return std::nullopt;
  }
  stored->erase(0, header_size);
  const std::lock_guard guard(mutex_);
  used_.insert(file(unit).filename().string());
  return stored;
}

void UnitCache::store(const std::string& unit, const Digest& key, std::string_view bytes) {
  std::filesystem::create_directories(directory_);
  write_file_atomically(file(unit), header(key_bytes(key), bytes) + std::string(bytes));
  const std::lock_guard guard(mutex_);
  used_.insert(file(unit).filename().string());
}

void UnitCache::remove_unused() {
  if (!std::filesystem::is_directory(directory_)) return;
  std::vector<std::filesystem::path> unused;
  for (const auto& entry : std::filesystem::directory_iterator(directory_)) {
    if (!used_.contains(entry.path().filename().string())) unused.push_back(entry.path());
  }
  for (const auto& path : unused) std::filesystem::remove(path);
}

}  // namespace planum
