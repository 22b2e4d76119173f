#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "slam/graph/loops.hpp"
#include "slam/graph/place_search.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/sequence.hpp"
#include "tools/workflow/results.hpp"
#include "tools/workflow/settings.hpp"
#include "tools/workflow/unit_cache.hpp"

namespace planum {

/// Matches pairs of imported scans by ICP and remembers each result as a unit, named after the two
/// scans. Scans are made ready when the first pair is not remembered. Any number of threads may
/// match.
class PairMatching {
 public:
  /// The results and the units must outlive it.
  PairMatching(Results& results, const Settings& settings, UnitCache& units,
               const Progress& progress);

  /// `first_gate` (m) in place of that of the settings.
  Alignment align(std::size_t target, std::size_t source, const Pose& guess, double first_gate);

  /// The scan after the earlier ones with all of those that overlap it; see MetascanMatcher.
  Alignment align_to_metascan(std::span<const Pose> earlier, const Pose& guess, double first_gate);

  /// Without a guess; no pairs if it is not sure where the source is. See locate().
  Alignment align_without_guess(std::size_t target, std::size_t source);

  /// For functions that match; it must outlive their calls.
  PairMatcher matcher();
  GatedPairMatcher gated_matcher();
  MetascanMatcher metascan_matcher();

 private:
  Alignment remembered(const std::string& name, const Digest& key,
                       const std::function<Alignment()>& match);

  Results& results_;
  UnitCache& units_;
  IcpParams icp_;
  /// Scans ready to be matched, made when first asked for.
  const std::vector<MatchingScan>& scans();

  Progress progress_;  ///< of making scans ready
  Digest parameters_;  ///< of all that a match depends on but the scans and the guess
  std::once_flag ready_;
  const std::vector<MatchingScan>* scans_ = nullptr;
  std::map<std::size_t, Place> places_;  ///< of the scans that were looked for without a guess
};

}  // namespace planum
