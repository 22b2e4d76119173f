#include "tools/planum/progress_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace planum {
namespace {

constexpr std::size_t bar_width = 24;

std::string bar(double share) {
  const auto full = static_cast<std::size_t>(std::floor(share * bar_width));
  return '[' + std::string(full, '#') + std::string(bar_width - full, '.') + ']';
}

}  // namespace

std::string progress_text(const ProgressState& state, std::size_t width) {
  std::string text = fmt::format("{:<10} ", state.label);
  if (state.total == 0) {
    text += fmt::format("working, {}", duration_text(state.seconds));
    return text.substr(0, width);
  }
  const double share =
      std::min(1.0, static_cast<double>(state.done) / static_cast<double>(state.total));
  text += fmt::format("{} {:3.0f} %", bar(share), std::floor(100 * share));
  if (state.done_in_phase > 0 && state.phase_seconds > 0) {
    const double rate = static_cast<double>(state.done_in_phase) / state.phase_seconds;
    const double left = static_cast<double>(state.total - std::min(state.done, state.total)) / rate;
    text += fmt::format("  {} {}/s  {} left", count_text(rate), state.unit, duration_text(left));
  }
  return text.substr(0, width);
}

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string count_text(double count) {
  if (count < 10) return fmt::format("{:.1f}", count);
  if (count < 1e4) return fmt::format("{:.0f}", count);
  if (count < 1e6) return fmt::format("{:.1f} k", count / 1e3);
  return fmt::format("{:.2f} M", count / 1e6);
}

}  // namespace planum
