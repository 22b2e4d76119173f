#include "tools/planum/console.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <sys/ioctl.h>
#include <thread>
#include <unistd.h>
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#pragma GCC diagnostic pop

#include "tools/planum/progress_text.hpp"

namespace planum {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto tick = std::chrono::milliseconds(100);
constexpr double show_after = 0.5;       // s
constexpr double plain_line_every = 10;  // s

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

class Console::Implementation {
 public:
  explicit Implementation(bool quiet)
      : quiet_(quiet),
        terminal_(isatty(STDERR_FILENO) == 1),
        log_(spdlog::stderr_color_mt("planum")) {
    log_->set_pattern("%v");
    if (!quiet_) ticker_ = std::jthread([this](std::stop_token stop) { run(stop); });
  }

  ~Implementation() {
    if (ticker_.joinable()) {
      ticker_.request_stop();
      wake_.notify_all();
      ticker_.join();
    }
    erase();
    spdlog::drop("planum");
  }

  void info(const std::string& text) {
    if (quiet_) return;
    const std::lock_guard guard(mutex_);
    erase();
    log_->info("{}", text);
  }

  void warn(const std::string& text) {
    const std::lock_guard guard(mutex_);
    erase();
    log_->warn("warning: {}", text);
  }

  void start(const std::string& label, const std::string& unit) {
    const std::lock_guard guard(mutex_);
    state_ = {.label = label, .unit = unit};
    first_done_ = 0;
    started_ = phase_started_ = last_plain_line_ = Clock::now();
    active_ = true;
  }

  void report(std::size_t done, std::size_t total) {
    const std::lock_guard guard(mutex_);
    if (total != state_.total || done < state_.done) {  // a new phase of the same work
      phase_started_ = Clock::now();
      first_done_ = done;
    }
    state_.done = done;
    state_.total = total;
    state_.done_in_phase = done - first_done_;
  }

  void end() {
    const std::lock_guard guard(mutex_);
    active_ = false;
    erase();
  }

 private:
  void run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      wake_.wait_for(lock, tick);
      if (active_ && !stop.stop_requested() && seconds_since(started_) > show_after) draw();
    }
  }

  void draw() {
    if (!terminal_ && seconds_since(last_plain_line_) < plain_line_every) return;
    last_plain_line_ = Clock::now();
    state_.phase_seconds = seconds_since(phase_started_);
    state_.seconds = seconds_since(started_);
    const std::string text = progress_text(state_, terminal_ ? terminal_width() - 1 : 100);
    if (terminal_) {
      std::fprintf(stderr, "\r\x1b[2K%s", text.c_str());
      drawn_ = true;
    } else {
      std::fprintf(stderr, "%s\n", text.c_str());
    }
    std::fflush(stderr);
  }

  void erase() {
    if (!drawn_) return;
    std::fputs("\r\x1b[2K", stderr);
    std::fflush(stderr);
    drawn_ = false;
  }

  const bool quiet_, terminal_;
  std::shared_ptr<spdlog::logger> log_;
  std::mutex mutex_;
  std::condition_variable wake_;
  ProgressState state_;
  std::size_t first_done_ = 0;
  Clock::time_point started_, phase_started_, last_plain_line_;
  bool active_ = false, drawn_ = false;
  std::jthread ticker_;
};

Console::Console(bool quiet) : console_(std::make_shared<Implementation>(quiet)) {}
Console::~Console() = default;

void Console::info(const std::string& text) { console_->info(text); }
void Console::warn(const std::string& text) { console_->warn(text); }

Progress Console::start_bar(const std::string& label, const std::string& unit) {
  console_->start(label, unit);
  return Progress(
      [console = console_](std::size_t done, std::size_t total) { console->report(done, total); });
}

void Console::end_bar() { console_->end(); }

}  // namespace planum
