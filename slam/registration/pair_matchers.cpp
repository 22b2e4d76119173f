#include "slam/registration/pair_matchers.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {

IcpParams with_first_gate(IcpParams params, double first_gate) {
  if (first_gate == 0) return params;
  params.first_gate = first_gate;
  params.last_gate = std::min(params.last_gate, first_gate);
  return params;
}

PairMatcher icp_matcher(std::span<const MatchingScan> scans, const IcpParams& params) {
  return [gated = icp_gated_matcher(scans, params)](std::size_t target, std::size_t source,
                                                    const Pose& guess) {
    return gated(target, source, guess, 0);
  };
}

GatedPairMatcher icp_gated_matcher(std::span<const MatchingScan> scans, const IcpParams& params) {
  return [scans, params](std::size_t target, std::size_t source, const Pose& guess,
                         double first_gate) {
    try {
      return align(scans[source], scans[target], guess, with_first_gate(params, first_gate));
    } catch (Error& error) {
      error.add_context(fmt::format("matching scan {} with scan {}", source, target));
      throw;
    }
  };
}

MetascanMatcher icp_metascan_matcher(std::span<const MatchingScan> scans, const IcpParams& params,
                                     const MetascanParams& metascan) {
  return [scans, params, metascan](std::span<const Pose> earlier, const Pose& guess,
                                   double first_gate) {
    const std::size_t source = earlier.size();
    try {
      const std::vector<std::size_t> members = metascan_members(scans, earlier, guess, metascan);
      if (members.empty()) return Alignment{.target_from_source = guess};
      return align(scans[source], metascan_of(scans, earlier, members), guess,
                   with_first_gate(params, first_gate));
    } catch (Error& error) {
      error.add_context(fmt::format("matching scan {} with the scans before it", source));
      throw;
    }
  };
}

}  // namespace planum
