#pragma once

#include <memory>
#include <string>

#include "slam/core/progress.hpp"

namespace planum {

/// What the program says on stderr while it works: finished lines, warnings, and a live bar where
/// stderr is a terminal (elsewhere a plain line every ten seconds). Any thread may speak.
class Console {
 public:
  /// Quiet: only warnings and errors.
  explicit Console(bool quiet);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  void info(const std::string& text);
  void warn(const std::string& text);

  /// Starts a bar for a piece of work; `unit` is what it counts ("scans"). A bar shows up when the
  /// work has taken half a second, and goes with `end_bar`.
  Progress start_bar(const std::string& label, const std::string& unit);
  void end_bar();

 private:
  class Implementation;
  std::shared_ptr<Implementation> console_;
};

}  // namespace planum
