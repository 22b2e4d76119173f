#include "tools/workflow/file_digests.hpp"

#include <chrono>
#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

void write(const std::filesystem::path& path, const std::string& text, int seconds_ago) {
  std::ofstream(path) << text;
  std::filesystem::last_write_time(
      path, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(seconds_ago));
}

TEST(FileDigests, AreThoseOfTheContent) {
  const testing::TemporaryDirectory directory;
  FileDigests digests(directory / "memory.json");
  write(directory / "a", "same", 10);
  write(directory / "b", "same", 20);
  EXPECT_EQ(digests.of(directory / "a"), digests.of(directory / "b"));
  EXPECT_EQ(digests.of(directory / "a"), digest_of_file(directory / "a"));
  EXPECT_EQ(digests.of_if_there(directory / "none"), Digest{});
  EXPECT_THROW(digests.of(directory / "none"), Error);
}

TEST(FileDigests, NoticeAChangeOfTheSameSize) {
  const testing::TemporaryDirectory directory;
  FileDigests digests(directory / "memory.json");
  write(directory / "a", "one", 10);
  const Digest before = digests.of(directory / "a");
  write(directory / "a", "two", 5);
  EXPECT_NE(digests.of(directory / "a"), before);
  // Within the resolution of time stamps: a file just written is read every time.
  write(directory / "a", "six", 0);
  const Digest six = digests.of(directory / "a");
  write(directory / "a", "ten", 0);
  EXPECT_NE(digests.of(directory / "a"), six);
}

TEST(FileDigests, RememberWithoutReading) {
  const testing::TemporaryDirectory directory;
  write(directory / "a", "one", 10);
  FileDigests digests(directory / "memory.json");
  const Digest digest = digests.of(directory / "a");
  digests.save();
  struct stat status {};
  ASSERT_EQ(stat((directory / "a").c_str(), &status), 0);
  // Another content under the same size, time and inode is not looked at: that is the short cut.
  { std::fstream(directory / "a", std::ios::in | std::ios::out) << "two"; }
  const timespec times[2] = {status.st_atim, status.st_mtim};
  ASSERT_EQ(utimensat(AT_FDCWD, (directory / "a").c_str(), times, 0), 0);
  EXPECT_EQ(FileDigests(directory / "memory.json").of(directory / "a"), digest);
}

TEST(FileDigests, StartAnewFromADamagedMemory) {
  const testing::TemporaryDirectory directory;
  write(directory / "a", "one", 10);
  for (const char* text : {"{", "{\"a\": 1}", "{\"a\": [1, 2, 3, \"x\"]}"}) {
    std::ofstream(directory / "memory.json") << text;
    FileDigests digests(directory / "memory.json");
    EXPECT_EQ(digests.of(directory / "a"), digest_of_file(directory / "a")) << text;
  }
}

}  // namespace
}  // namespace planum
