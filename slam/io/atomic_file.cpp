#include "slam/io/atomic_file.hpp"

#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <ostream>
#include <streambuf>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;

std::string advice(int reason, const fs::path& path) {
  const std::string directory = path.has_parent_path() ? path.parent_path().string() : ".";
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or write elsewhere";
    case EFBIG:
      return "raise the limit on file sizes or write elsewhere";
    case EACCES:
    case EPERM:
    case EROFS:
      return "make " + directory + " writable or write elsewhere";
    case ENOENT:
      return "make the directory " + directory + " first";
    case ENOTDIR:
      return directory + " is not a directory: write elsewhere";
    case EWOULDBLOCK:
      return "another program is writing it: wait for that or write elsewhere";
    default:
      return "try again or write elsewhere";
  }
}

[[noreturn]] void fail(const fs::path& path, const char* action, int reason) {
  const std::string cause =
      reason == EWOULDBLOCK ? "it is locked" : std::generic_category().message(reason);
  throw Error(
      path.string() + ": cannot " + action + ": " + cause + " (" + advice(reason, path) + ")",
      ErrorKind::environment);
}

/// Where a write to `path` ends up: behind symbolic links. Throws if that is no regular file.
fs::path final_path(const fs::path& path) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) != 0) return path;
  if (S_ISREG(status.st_mode)) {
    std::error_code unresolved;
    const fs::path target = fs::canonical(path, unresolved);
    return unresolved ? path : target;
  }
  throw Error(path.string() + ": cannot write: it is " +
                  (S_ISDIR(status.st_mode) ? "a directory" : "not a regular file") +
                  " (choose another name)",
              ErrorKind::environment);
}

/// Whether `path` still names the open file: another writer may have renamed or removed it.
bool names(const fs::path& path, int descriptor) {
  struct stat by_name = {}, by_descriptor = {};
  return ::stat(path.c_str(), &by_name) == 0 && ::fstat(descriptor, &by_descriptor) == 0 &&
         by_name.st_ino == by_descriptor.st_ino && by_name.st_dev == by_descriptor.st_dev;
}

/// Opens `part` for this writer alone, empty. What a killed program left there is overwritten.
int open_alone(const fs::path& part, const fs::path& path) {
  constexpr int max_attempts = 100;
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) fail(path, "open for writing", errno);
    // A file system without locks (any other failure) is used without them.
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(descriptor);
      fail(path, "open for writing", EWOULDBLOCK);
    }
    if (names(part, descriptor)) {
      if (::ftruncate(descriptor, 0) == 0) return descriptor;
      const int reason = errno;
      ::close(descriptor);
      fail(path, "open for writing", reason);
    }
    ::close(descriptor);
  }
  fail(path, "open for writing", EWOULDBLOCK);
}

}  // namespace

class AtomicFile::Implementation : public std::streambuf {
 public:
  explicit Implementation(const fs::path& path)
      : path_(path),
        target_(final_path(path)),
        part_(target_.parent_path() / ("." + target_.filename().string() + ".part")),
        descriptor_(open_alone(part_, path_)),
        stream_(this) {
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    // Errors thrown from the buffer pass through the stream instead of being swallowed.
    stream_.exceptions(std::ios::badbit);
  }

  ~Implementation() override {
    if (!committed_) ::unlink(part_.c_str());
    ::close(descriptor_);
  }

  void write(const char* bytes, std::size_t count) {
    assert(!committed_);
    while (count > 0) {
      const ssize_t written = ::write(descriptor_, bytes, count);
      if (written > 0) {
        bytes += written;
        count -= static_cast<std::size_t>(written);
      } else if (written == 0 || errno != EINTR) {
        throw_failure("write", written == 0 ? EIO : errno);
      }
    }
  }

  void flush_buffer() {
    const auto count = static_cast<std::size_t>(pptr() - pbase());
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    write(buffer_.data(), count);
  }

  void commit() {
    flush_buffer();
    if (failed_) throw_failure("write", failed_);
    if (::fsync(descriptor_) != 0) throw_failure("write", errno);
    if (::rename(part_.c_str(), target_.c_str()) != 0) throw_failure("rename", errno);
    committed_ = true;
  }

  std::ostream& stream() { return stream_; }

 protected:
  int_type overflow(int_type c) override {
    flush_buffer();
    if (c != traits_type::eof()) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  int sync() override {
    flush_buffer();
    return 0;
  }

 private:
  [[noreturn]] void throw_failure(const char* action, int reason) {
    failed_ = reason;
    fail(path_, action, reason);
  }

  fs::path path_;
  fs::path target_;
  fs::path part_;
  int descriptor_;
  int failed_ = 0;  ///< the reason of an earlier failure: such a file is never committed
  bool committed_ = false;
  std::array<char, 1 << 16> buffer_;
  std::ostream stream_;
};

AtomicFile::AtomicFile(const fs::path& path) : file_(std::make_unique<Implementation>(path)) {}
AtomicFile::~AtomicFile() = default;

void AtomicFile::write(std::string_view text) {
  file_->flush_buffer();
  file_->write(text.data(), text.size());
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  write(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

std::ostream& AtomicFile::stream() { return file_->stream(); }

void AtomicFile::commit() { file_->commit(); }

void write_file_atomically(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace planum
