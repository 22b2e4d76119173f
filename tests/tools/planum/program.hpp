#pragma once

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"

namespace planum::testing {

/// What a program run left.
struct Outcome {
  int exit_code = 0;  ///< 128 + signal where a signal ended it
  std::string out, err;
};

/// How to disturb a run.
struct Disturbance {
  std::optional<std::chrono::microseconds> signal_after = std::nullopt;
  int signal = SIGKILL;
  rlim_t max_file_bytes = RLIM_INFINITY;
};

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Runs `planum ARGUMENTS` in a directory.
class Program {
 public:
  explicit Program(std::filesystem::path directory) : directory_(std::move(directory)) {}

  Outcome operator()(const std::vector<std::string>& arguments,
                     const Disturbance& disturbance = {}) const {
    const TemporaryDirectory streams;
    const pid_t child = start(arguments, streams.path(), disturbance);
    if (disturbance.signal_after) {
      std::this_thread::sleep_for(*disturbance.signal_after);
      kill(child, disturbance.signal);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            file_text(streams / "out"), file_text(streams / "err")};
  }

 private:
  pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& streams,
              const Disturbance& disturbance) const {
    std::vector<std::string> words = {PLANUM_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string out = streams / "out", err = streams / "err";
    const pid_t child = fork();
    if (child != 0) return child;
    if (chdir(directory_.c_str()) != 0) _exit(99);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (disturbance.max_file_bytes != RLIM_INFINITY) {
      const rlimit limit = {disturbance.max_file_bytes, disturbance.max_file_bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(PLANUM_PROGRAM, pointers.data());
    _exit(99);
  }

  std::filesystem::path directory_;
};

/// EXPECT_SAYS(text, part): the part is in it, else both are printed.
#define EXPECT_SAYS(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "expected: " << (part) << "\nin:\n" << (text)

}  // namespace planum::testing
