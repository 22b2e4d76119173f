#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "slam/registration/matching_scan.hpp"
#include "slam/registration/sequence.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/settings.hpp"
#include "tools/workflow/unit_cache.hpp"

namespace planum {

/// Matches pairs of imported scans by ICP and remembers each result as a unit, named after the two
/// scans. Scans are made ready when first needed: a pair that is remembered costs nothing. Any
/// number of threads may match.
class PairMatching {
 public:
  /// The scans and the units must outlive it.
  PairMatching(const Imported& imported, const Settings& settings, UnitCache& units);

  Alignment align(std::size_t target, std::size_t source, const Pose& guess);

  /// For functions that match; it must outlive their calls.
  PairMatcher matcher();

 private:
  const MatchingScan& scan(std::size_t index);

  const Imported& imported_;
  UnitCache& units_;
  MatchingScanParams matching_;
  IcpParams icp_;
  Digest parameters_;  ///< of all that a match depends on but the scans and the guess
  std::vector<std::unique_ptr<MatchingScan>> scans_;
  std::vector<std::once_flag> ready_;
};

}  // namespace planum
