#include "tools/workflow/pair_matching.hpp"

#include "slam/core/error.hpp"
#include "tools/workflow/stored_types.hpp"

namespace planum {

namespace {

/// Grows when matching gives other results from the same scans and parameters.
constexpr int matching_version = 2;

}  // namespace

PairMatching::PairMatching(Results& results, const Settings& settings, UnitCache& units,
                           const Progress& progress)
    : results_(results), units_(units), icp_(settings.icp), progress_(progress) {
  icp_.pairing = pairing_of(settings);
  icp_.minimizer = minimizer_of(settings);
  parameters_ = Hasher()
                    .value(matching_version)
                    .text(archived(settings.matching))
                    .text(archived(icp_))
                    .result();
}

Alignment PairMatching::align(std::size_t target, std::size_t source, const Pose& guess,
                              double first_gate) {
  const Imported& imported = results_.imported.get();
  const Digest key = Hasher()
                         .digest(parameters_)
                         .digest(imported.digests[target])
                         .digest(imported.digests[source])
                         .bytes(guess.data(), sizeof(double) * 16)
                         .value(first_gate)
                         .result();
  const std::string pair = imported.scans[target].id + "-" + imported.scans[source].id;
  // A pair may be matched again from another guess: the end of the name tells them apart.
  const std::string unit = pair + "-" + to_string(key).substr(0, 8);
  if (const auto bytes = units_.find(unit, key)) return unarchived<Alignment>(*bytes);
  std::call_once(ready_, [&] { scans_ = &results_.matching_scans(progress_); });
  IcpParams params = icp_;
  params.first_gate = first_gate;
  try {
    const Alignment alignment = planum::align((*scans_)[source], (*scans_)[target], guess, params);
    units_.store(unit, key, archived(alignment));
    return alignment;
  } catch (Error& error) {
    error.add_context(pair);
    throw;
  }
}

PairMatcher PairMatching::matcher() {
  return [this](std::size_t target, std::size_t source, const Pose& guess) {
    return align(target, source, guess, icp_.first_gate);
  };
}

GatedPairMatcher PairMatching::loop_matcher() {
  return [this](std::size_t target, std::size_t source, const Pose& guess, double first_gate) {
    return align(target, source, guess, first_gate);
  };
}

}  // namespace planum
