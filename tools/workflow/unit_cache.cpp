#include "tools/workflow/unit_cache.hpp"

#include <fstream>
#include <iterator>
#include <vector>

#include "slam/io/atomic_file.hpp"

namespace planum {
namespace {

constexpr std::size_t header_size = 2 * sizeof(Digest);

/// Digests of what the unit depends on and of its bytes.
std::string header(const Digest& key, std::string_view bytes) {
  const Digest content = Hasher().bytes(bytes.data(), bytes.size()).result();
  std::string text;
  for (const Digest& digest : {key, content}) {
    text.append(reinterpret_cast<const char*>(digest.words.data()), sizeof digest.words);
  }
  return text;
}

}  // namespace

UnitCache::UnitCache(std::filesystem::path directory) : directory_(std::move(directory)) {}

std::filesystem::path UnitCache::file(const std::string& unit) const {
  return directory_ / (unit + ".unit");
}

std::optional<std::string> UnitCache::find(const std::string& unit, const Digest& key) {
  std::ifstream stream(file(unit), std::ios::binary);
  if (!stream) return std::nullopt;
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (bytes.size() < header_size) return std::nullopt;
  const std::string_view content = std::string_view(bytes).substr(header_size);
  if (header(key, content) != std::string_view(bytes).substr(0, header_size)) return std::nullopt;
  bytes.erase(0, header_size);
  const std::lock_guard guard(mutex_);
  used_.insert(file(unit).filename().string());
  return bytes;
}

void UnitCache::store(const std::string& unit, const Digest& key, std::string_view bytes) {
  std::filesystem::create_directories(directory_);
  write_file_atomically(file(unit), header(key, bytes) + std::string(bytes));
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
