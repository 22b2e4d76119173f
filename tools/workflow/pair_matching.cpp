#include "tools/workflow/pair_matching.hpp"

#include "slam/core/error.hpp"
#include "tools/workflow/stored_types.hpp"

namespace planum {

namespace {

/// Grows when matching gives other results from the same scans and parameters.
constexpr int matching_version = 3;

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
  return remembered(pair, key, [&] {
    return planum::align(scans()[source], scans()[target], guess,
                         with_first_gate(icp_, first_gate));
  });
}

Alignment PairMatching::align_to_metascan(std::span<const Pose> earlier, const Pose& guess,
                                          double first_gate) {
  const Imported& imported = results_.imported.get();
  const std::size_t source = earlier.size();
  const std::vector<std::size_t> members = metascan_members(scans(), earlier, guess);
  if (members.empty()) return {.target_from_source = guess};
  Hasher hasher;
  hasher.digest(parameters_).digest(imported.digests[source]).value(first_gate);
  hasher.bytes(guess.data(), sizeof(double) * 16);
  for (const std::size_t i : members) {
    const Pose target_from_scan = earlier.back().inverse() * earlier[i];
    hasher.digest(imported.digests[i]).bytes(target_from_scan.data(), sizeof(double) * 16);
  }
  return remembered("metascan-" + imported.scans[source].id, hasher.result(), [&] {
    return planum::align(scans()[source], metascan_of(scans(), earlier, members), guess,
                         with_first_gate(icp_, first_gate));
  });
}

Alignment PairMatching::align_without_guess(std::size_t target, std::size_t source) {
  const Imported& imported = results_.imported.get();
  const Digest key = Hasher()
                         .text("without a guess")
                         .digest(parameters_)
                         .digest(imported.digests[target])
                         .digest(imported.digests[source])
                         .result();
  const auto place = [this](std::size_t scan) -> const Place& {
    const auto known = places_.find(scan);
    return known != places_.end() ? known->second
                                  : places_.emplace(scan, place_of(scans()[scan])).first->second;
  };
  return remembered(imported.scans[target].id + "-" + imported.scans[source].id, key, [&] {
    const Location location = locate(place(source), place(target), {.matching = icp_});
    return location.found ? location.alignment : Alignment{};
  });
}

Alignment PairMatching::remembered(const std::string& name, const Digest& key,
                                   const std::function<Alignment()>& match) {
  // The same scans may be matched again from another guess: the end of the name tells them apart.
  const std::string unit = name + "-" + to_string(key).substr(0, 8);
  if (const auto bytes = units_.find(unit, key)) return unarchived<Alignment>(*bytes);
  try {
    const Alignment alignment = match();
    units_.store(unit, key, archived(alignment));
    return alignment;
  } catch (Error& error) {
    error.add_context(name);
    throw;
  }
}

const std::vector<MatchingScan>& PairMatching::scans() {
  std::call_once(ready_, [&] { scans_ = &results_.matching_scans(progress_); });
  return *scans_;
}

PairMatcher PairMatching::matcher() {
  return [this](std::size_t target, std::size_t source, const Pose& guess) {
    return align(target, source, guess, icp_.first_gate);
  };
}

GatedPairMatcher PairMatching::gated_matcher() {
  return [this](std::size_t target, std::size_t source, const Pose& guess, double first_gate) {
    return align(target, source, guess, first_gate);
  };
}

MetascanMatcher PairMatching::metascan_matcher() {
  return [this](std::span<const Pose> earlier, const Pose& guess, double first_gate) {
    return align_to_metascan(earlier, guess, first_gate);
  };
}

}  // namespace planum
