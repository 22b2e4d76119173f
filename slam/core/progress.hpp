#pragma once

#include <cstddef>
#include <functional>

namespace planum {

/// Where a long computation says how far it is. A default-constructed one is silent. Copies share
/// the sink; `report` may be called from any thread if the sink allows it (those of the program
/// do).
class Progress {
 public:
  using Sink = std::function<void(std::size_t done, std::size_t total)>;

  Progress() = default;
  explicit Progress(Sink sink) : sink_(std::move(sink)) {}

  /// `done` of `total` units of work (scans, pairs, points ...) are finished.
  void report(std::size_t done, std::size_t total) const {
    if (sink_) sink_(done, total);
  }

 private:
  Sink sink_;
};

}  // namespace planum
