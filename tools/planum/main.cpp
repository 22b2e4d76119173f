#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <unistd.h>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "tools/planum/command_line.hpp"

namespace {

constexpr int internal_error = 1, usage = 2, bad_input = 3, no_result = 4, environment = 5;

int exit_code(planum::ErrorKind kind) {
  switch (kind) {
    case planum::ErrorKind::usage:
      return usage;
    case planum::ErrorKind::input:
      return bad_input;
    case planum::ErrorKind::no_result:
      return no_result;
    case planum::ErrorKind::environment:
      return environment;
  }
  return internal_error;
}

/// Files appear only when complete, so there is nothing to put in order; write and _exit are what a
/// signal handler may call.
extern "C" void interrupted(int signal) {
  constexpr char message[] =
      "\nInterrupted. What was finished is kept: the same command goes on from there.\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
  _exit(128 + signal);
}

void fail(const std::string& message) { fmt::print(stderr, "planum: error: {}\n", message); }

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, interrupted);
  std::signal(SIGTERM, interrupted);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error of write() like a full disk
  try {
    planum::command_line(argc, argv);
    return EXIT_SUCCESS;
  } catch (const planum::Error& error) {
    fail(error.what());
    return exit_code(error.kind());
  } catch (const std::filesystem::filesystem_error& error) {
    fail(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    return environment;
  } catch (const std::bad_alloc&) {
    fail("there is not enough memory");
    return environment;
  } catch (const std::exception& error) {
    fail(fmt::format("{} (this is a fault of the program, please report it)", error.what()));
    return internal_error;
  }
}
