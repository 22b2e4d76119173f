#pragma once

#include <cstddef>
#include <string>

namespace planum {

/// How far a piece of work is.
struct ProgressState {
  std::string label;  ///< "mesh"
  std::string unit;   ///< what is counted: "points"
  std::size_t done = 0;
  std::size_t total = 0;          ///< 0: unknown
  std::size_t done_in_phase = 0;  ///< since phase_seconds ago
  double phase_seconds = 0;
  double seconds = 0;  ///< since the work began
};

/// One line of at most `width` columns: label, bar, share, rate and time left.
std::string progress_text(const ProgressState& state, std::size_t width);

/// "0.85 s", "12 s", "2 min 5 s".
std::string duration_text(double seconds);

/// "950", "12.3 k", "1.79 M".
std::string count_text(double count);

}  // namespace planum
