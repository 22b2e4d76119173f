#include "slam/io/atomic_file.hpp"

#include <csignal>
#include <ostream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_of;
using testing::TemporaryDirectory;
using testing::text_of;
using testing::write_text;

std::size_t files_in(const std::filesystem::path& directory) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(directory), {}));
}

ErrorKind kind_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::usage;
}

/// While it lives files of this process cannot grow beyond a size, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_ = {};
};

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const TemporaryDirectory directory;
  const auto path = directory / "result.txt";
  write_text(path, "earlier");
  {
    AtomicFile file(path);
    file.write("one ");
    file.stream() << "two " << 3;
    file.write(" four");
    EXPECT_EQ(text_of(path), "earlier");
    file.commit();
    EXPECT_EQ(text_of(path), "one two 3 four");
  }
  EXPECT_EQ(text_of(path), "one two 3 four");
  EXPECT_EQ(files_in(directory.path()), 1u);
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const TemporaryDirectory directory;
  { AtomicFile(directory / "new.txt").write("half"); }
  EXPECT_EQ(files_in(directory.path()), 0u);
}

TEST(AtomicFile, OverwritesWhatAKilledProgramLeft) {
  const TemporaryDirectory directory;
  write_text(directory / ".result.txt.part", "a long rest of an earlier program");
  write_file_atomically(directory / "result.txt", "short");
  EXPECT_EQ(text_of(directory / "result.txt"), "short");
  EXPECT_EQ(files_in(directory.path()), 1u);
}

TEST(AtomicFile, KeepsTheEarlierFileWhenTheDiskIsFull) {
  const TemporaryDirectory directory;
  const auto path = directory / "cloud.ply";
  write_text(path, "earlier");
  const std::string large(100'000, 'x');
  const std::string expected = path.string() +
                               ": cannot write: File too large (raise the limit on file sizes or "
                               "write elsewhere)";
  const FileSizeLimit limit(10'000);
  EXPECT_EQ(error_of([&] { write_file_atomically(path, large); }), expected);
  EXPECT_EQ(kind_of([&] { write_file_atomically(path, large); }), ErrorKind::environment);
  EXPECT_EQ(error_of([&] {
              AtomicFile file(path);
              for (int i = 0; i < 100'000; ++i) file.stream() << 'x';
              file.commit();
            }),
            expected);
  EXPECT_EQ(text_of(path), "earlier");
  EXPECT_EQ(files_in(directory.path()), 1u);
}

TEST(AtomicFile, IsNotCommittedAfterAFailedWrite) {
  const TemporaryDirectory directory;
  const auto path = directory / "cloud.ply";
  const FileSizeLimit limit(10'000);
  AtomicFile file(path);
  EXPECT_NE(error_of([&] { file.write(std::string(100'000, 'x')); }), "");
  EXPECT_NE(error_of([&] { file.commit(); }), "");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(AtomicFile, SaysWhatToDoAboutAMissingDirectory) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "absent" / "map.obj";
  EXPECT_EQ(error_of([&] { write_file_atomically(path, "x"); }),
            path.string() +
                ": cannot open for writing: No such file or directory (make the "
                "directory " +
                path.parent_path().string() + " first)");
}

TEST(AtomicFile, SaysThatItsDirectoryIsAFile) {
  const TemporaryDirectory directory;
  write_text(directory / "out", "a file");
  const auto path = directory.path() / "out" / "map.obj";
  EXPECT_EQ(error_of([&] { write_file_atomically(path, "x"); }),
            path.string() + ": cannot open for writing: Not a directory (" +
                path.parent_path().string() + " is not a directory: write elsewhere)");
  EXPECT_EQ(kind_of([&] { write_file_atomically(path, "x"); }), ErrorKind::environment);
}

TEST(AtomicFile, SaysThatADirectoryIsNotWritable) {
  if (geteuid() == 0) GTEST_SKIP() << "root writes everywhere";
  const TemporaryDirectory directory;
  const auto path = directory / "map.obj";
  write_text(path, "earlier");
  chmod(directory.path().c_str(), 0555);
  const std::string message = error_of([&] { write_file_atomically(path, "x"); });
  chmod(directory.path().c_str(), 0755);
  EXPECT_EQ(message, path.string() + ": cannot open for writing: Permission denied (make " +
                         directory.path().string() + " writable or write elsewhere)");
  EXPECT_EQ(text_of(path), "earlier");
}

TEST(AtomicFile, DoesNotOverwriteDirectoriesAndDevices) {
  const TemporaryDirectory directory;
  EXPECT_EQ(error_of([&] { write_file_atomically(directory.path(), "x"); }),
            directory.path().string() + ": cannot write: it is a directory (choose another name)");
  EXPECT_EQ(error_of([&] { write_file_atomically("/dev/null", "x"); }),
            "/dev/null: cannot write: it is not a regular file (choose another name)");
}

TEST(AtomicFile, FollowsALinkToItsFile) {
  const TemporaryDirectory directory;
  write_text(directory / "real.txt", "earlier");
  std::filesystem::create_symlink("real.txt", directory / "link.txt");
  write_file_atomically(directory / "link.txt", "new");
  EXPECT_EQ(text_of(directory / "real.txt"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link.txt"));
}

TEST(AtomicFile, TurnsASecondWriterAway) {
  const TemporaryDirectory directory;
  const auto path = directory / "map.obj";
  AtomicFile first(path);
  EXPECT_EQ(error_of([&] { AtomicFile second(path); }),
            path.string() +
                ": cannot open for writing: it is locked (another program is writing "
                "it: wait for that or write elsewhere)");
  first.write("first");
  first.commit();
  write_file_atomically(path, "second");
  EXPECT_EQ(text_of(path), "second");
}

TEST(AtomicFile, TakesANameWithoutADirectory) {
  const TemporaryDirectory directory;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  write_file_atomically("here.txt", "x");
  std::filesystem::current_path(before);
  EXPECT_EQ(text_of(directory / "here.txt"), "x");
}

}  // namespace
}  // namespace planum
