#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"

namespace planum::testing {

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  // A new file: some file systems wait for the disk when an old one is cut to nothing.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The message of the Error that `action` throws; empty if it throws none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The error in reading `text` from a file with the given name; the file's path is written as FILE.
inline std::string error_in_text(const std::filesystem::path& file, const std::string& text,
                                 const std::function<void(const std::filesystem::path&)>& read) {
  write_text(file, text);
  std::string message = error_of([&] { read(file); });
  const std::size_t at = message.find(file.string());
  if (at != std::string::npos) message.replace(at, file.string().size(), "FILE");
  return message;
}

/// Random draws with a fixed seed.
class Draws {
 public:
  explicit Draws(unsigned seed) : engine_(seed) {}

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine_);
  }
  std::size_t below(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(engine_);
  }
  Eigen::Vector3d vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Pose pose() {
    Pose result = Pose::Identity();
    result.linear() =
        Eigen::AngleAxisd(uniform(-pi, pi), vector(1).normalized()).toRotationMatrix();
    result.translation() = vector(100);
    return result;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace planum::testing
