#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace planum {

/// A 128-bit fingerprint of bytes (XXH3): equal digests mean equal content for all that we do.
struct Digest {
  std::array<std::uint64_t, 2> words{};

  friend auto operator<=>(const Digest&, const Digest&) = default;
};

/// 32 hexadecimal digits.
std::string to_string(const Digest& digest);

/// The digest that to_string wrote; throws Error if it is none.
Digest digest_from_string(std::string_view text);

/// Collects bytes for a digest. Numbers, strings and lists are added with their length, so that
/// ("ab", "c") and ("a", "bc") differ.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& bytes(const void* data, std::size_t size);
  Hasher& text(std::string_view text);
  Hasher& digest(const Digest& digest);

  /// Anything without padding or pointers: numbers, Eigen vectors of fixed size, arrays of these.
  template <class T>
  Hasher& value(const T& value) {
    return bytes(&value, sizeof(T));
  }

  template <class T>
  Hasher& list(const std::vector<T>& values) {
    value(static_cast<std::uint64_t>(values.size()));
    return bytes(values.data(), values.size() * sizeof(T));
  }

  Digest result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The digest of a file's content; throws Error if it cannot be read.
Digest digest_of_file(const std::filesystem::path& path);

}  // namespace planum
