#include "tools/workflow/pair_matching.hpp"

#include "slam/core/error.hpp"
#include "tools/workflow/stored_types.hpp"

namespace planum {

namespace {

/// Grows when matching gives other results from the same scans and parameters.
constexpr int matching_version = 1;

}  // namespace

PairMatching::PairMatching(const Imported& imported, const Settings& settings, UnitCache& units)
    : imported_(imported),
      units_(units),
      matching_(settings.matching),
      icp_(settings.icp),
      scans_(imported.scans.size()),
      ready_(imported.scans.size()) {
  icp_.pairing =
      settings.pairing == "point-to-point" ? Pairing::point_to_point : Pairing::point_to_plane;
  parameters_ =
      Hasher().value(matching_version).text(archived(matching_)).text(archived(icp_)).result();
}

const MatchingScan& PairMatching::scan(std::size_t index) {
  std::call_once(ready_[index], [&] {
    scans_[index] =
        std::make_unique<MatchingScan>(matching_scan(imported_.scans[index].cloud, matching_));
  });
  return *scans_[index];
}

Alignment PairMatching::align(std::size_t target, std::size_t source, const Pose& guess) {
  const std::string unit = imported_.scans[target].id + "-" + imported_.scans[source].id;
  const Digest key = Hasher()
                         .digest(parameters_)
                         .digest(imported_.digests[target])
                         .digest(imported_.digests[source])
                         .bytes(guess.data(), sizeof(double) * 16)
                         .result();
  if (const auto bytes = units_.find(unit, key)) return unarchived<Alignment>(*bytes);
  try {
    const Alignment alignment = planum::align(scan(source), scan(target), guess, icp_);
    units_.store(unit, key, archived(alignment));
    return alignment;
  } catch (Error& error) {
    error.add_context(unit);
    throw;
  }
}

PairMatcher PairMatching::matcher() {
  return [this](std::size_t target, std::size_t source, const Pose& guess) {
    return align(target, source, guess);
  };
}

}  // namespace planum
