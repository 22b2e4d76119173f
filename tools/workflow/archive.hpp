#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "slam/core/error.hpp"

namespace planum {

/// Values that are a fixed block of numbers in memory, without padding.
template <class T>
struct IsPlain : std::bool_constant<std::is_arithmetic_v<T> || std::is_enum_v<T>> {};
template <class T, std::size_t N>
struct IsPlain<std::array<T, N>> : IsPlain<T> {};
template <class T, int Rows, int Columns>
struct IsPlain<Eigen::Matrix<T, Rows, Columns>>
    : std::bool_constant<Rows != Eigen::Dynamic && Columns != Eigen::Dynamic> {};
template <>
struct IsPlain<Eigen::Isometry3d> : std::true_type {};

/// Results kept between runs, as the bytes they have in memory: exact, so that a result from disk
/// is the same as one that was never there. A struct takes part by a function that names its
/// members once for both directions:
///
///     template <class Archive> void fields(Archive& archive, Scan& scan) {
///       archive(scan.id, scan.number, scan.world_from_scan, scan.cloud);
///     }
class ArchiveWriter {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  void write(const T& value) {
    if constexpr (IsPlain<T>::value) {
      append(&value, sizeof(T));
    } else {
      fields(*this, const_cast<T&>(value));  // only read: one function serves both directions
    }
  }
  void write(const std::string& text) {
    write(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(static_cast<std::uint64_t>(values.size()));
    if constexpr (IsPlain<T>::value) {
      append(values.data(), values.size() * sizeof(T));
    } else {
      for (const T& value : values) write(value);
    }
  }
  void append(const void* data, std::size_t size) {
    if (size > 0) bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;
};

/// Reads what an ArchiveWriter wrote; throws Error if the bytes end too early.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  template <class T>
  void read(T& value) {
    if constexpr (IsPlain<T>::value) {
      take(&value, sizeof(T));
    } else {
      fields(*this, value);
    }
  }
  void read(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  template <class T>
  void read(std::vector<T>& values) {
    if constexpr (IsPlain<T>::value) {
      values.resize(count(sizeof(T)));
      take(values.data(), values.size() * sizeof(T));
    } else {
      values.resize(count(1));
      for (T& value : values) read(value);
    }
  }
  std::size_t count(std::size_t least_bytes_each) {
    std::uint64_t number = 0;
    read(number);
    if (number > bytes_.size() / least_bytes_each) throw_truncated();
    return number;
  }
  void take(void* data, std::size_t size) {
    if (size > bytes_.size()) throw_truncated();
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  [[noreturn]] static void throw_truncated() { throw Error("the stored result is truncated"); }

  std::string_view bytes_;
};

/// The bytes of one value.
template <class T>
std::string archived(const T& value) {
  ArchiveWriter writer;
  writer(value);
  return writer.bytes();
}

/// The value of bytes that `archived` made.
template <class T>
T unarchived(std::string_view bytes) {
  T value{};
  ArchiveReader reader(bytes);
  reader(value);
  if (!reader.at_end()) throw Error("the stored result has more bytes than expected");
  return value;
}

}  // namespace planum
