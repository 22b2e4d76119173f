#include "slam/io/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* action, int reason) {
  const bool wrong_path = reason == ENOENT || reason == ENOTDIR || reason == EISDIR;
  throw Error(path.string() + ": cannot " + action + ": " + std::generic_category().message(reason),
              wrong_path ? ErrorKind::input : ErrorKind::environment);
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail(path_, "open", errno);
  struct stat status = {};
  const bool known = ::fstat(descriptor_, &status) == 0;
  if (known && S_ISDIR(status.st_mode)) {
    ::close(descriptor_);
    fail(path_, "read", EISDIR);
  }
  if (known && S_ISREG(status.st_mode)) size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

std::size_t InputFile::read(std::span<char> bytes) {
  std::size_t count = 0;
  while (count < bytes.size()) {
    const ssize_t got = ::read(descriptor_, bytes.data() + count, bytes.size() - count);
    if (got == 0) break;
    if (got > 0) {
      count += static_cast<std::size_t>(got);
    } else if (errno != EINTR) {
      fail(path_, "read", errno);
    }
  }
  return count;
}

void InputFile::seek(std::uint64_t offset) {
  if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) fail(path_, "seek", errno);
}

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  constexpr std::size_t smallest_block = 1 << 16;
  InputFile file(path);
  std::string text;
  std::size_t count = 0;
  // One byte more than the file has, so that its end is seen by the first read.
  std::size_t block = std::max<std::size_t>(file.size() + 1, smallest_block);
  while (count < max_bytes) {
    text.resize(std::min(count + block, max_bytes));
    const std::size_t wanted = text.size() - count;
    const std::size_t got = file.read({text.data() + count, wanted});
    count += got;
    if (got < wanted) break;
    block = count;
  }
  text.resize(count);
  return text;
}

}  // namespace planum
