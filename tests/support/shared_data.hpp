#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum::testing {

/// ../shared/datasets/NAME beside the project, if it is there.
inline std::optional<std::filesystem::path> shared_dataset(const std::string& name) {
  const auto path =
      std::filesystem::path(PLANUM_SOURCE_DIR).parent_path() / "shared" / "datasets" / name;
  if (std::filesystem::exists(path)) return path;
  return std::nullopt;
}

/// A fresh directory for one test, removed at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "planum-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("cannot make " + pattern);
    path_ = pattern;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Expects that a call cannot write `path`, and says so as a fault of the environment.
template <class Call>
void expect_cannot_write(const std::filesystem::path& path, const Call& call) {
  try {
    call();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::environment);
    EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": cannot open for writing"))
        << error.what();
  }
}

}  // namespace planum::testing

/// Skips the test where the shared data set is absent; otherwise `path` names its directory.
#define PLANUM_SHARED_DATASET(path, name)                                        \
  const auto path##_if_there = ::planum::testing::shared_dataset(name);          \
  if (!path##_if_there) GTEST_SKIP() << "../shared/datasets/" name " is absent"; \
  const auto path = *path##_if_there
