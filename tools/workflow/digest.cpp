#include "tools/workflow/digest.hpp"

#define XXH_INLINE_ALL
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <xxhash.h>
#pragma GCC diagnostic pop

#include <charconv>
#include <cstdio>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {

struct Hasher::State {
  XXH3_state_t* hash = XXH3_createState();
  State() { XXH3_128bits_reset(hash); }
  ~State() { XXH3_freeState(hash); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

std::string to_string(const Digest& digest) {
  return fmt::format("{:016x}{:016x}", digest.words[0], digest.words[1]);
}

Digest digest_from_string(std::string_view text) {
  Digest digest;
  if (text.size() == 32) {
    const char* begin = text.data();
    const auto first = std::from_chars(begin, begin + 16, digest.words[0], 16);
    const auto second = std::from_chars(begin + 16, begin + 32, digest.words[1], 16);
    if (first.ptr == begin + 16 && second.ptr == begin + 32) return digest;
  }
  throw Error(fmt::format("expected a digest of 32 hexadecimal digits, got '{}'", text));
}

Hasher::Hasher() : state_(std::make_unique<State>()) {}
Hasher::~Hasher() = default;

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  if (size > 0) XXH3_128bits_update(state_->hash, data, size);
  return *this;
}

Hasher& Hasher::text(std::string_view text) {
  value(static_cast<std::uint64_t>(text.size()));
  return bytes(text.data(), text.size());
}

Hasher& Hasher::digest(const Digest& digest) { return value(digest.words); }

Digest Hasher::result() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_->hash);
  return {{hash.high64, hash.low64}};
}

Digest digest_of_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) throw Error(fmt::format("{}: cannot open: {}", path.string(), std::strerror(errno)));
  Hasher hasher;
  std::vector<char> buffer(1 << 18);
  std::size_t got = 0;
  while ((got = std::fread(buffer.data(), 1, buffer.size(), file.get())) > 0) {
    hasher.bytes(buffer.data(), got);
  }
  if (std::ferror(file.get())) {
    throw Error(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
  }
  return hasher.result();
}

}  // namespace planum
