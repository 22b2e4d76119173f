#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "slam/core/pose.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/metascan.hpp"

namespace planum {

// Functions that match scans by their numbers in a list. Whoever calls matching functions may put
// ones that remember their results on disk in place of those that are made here.

/// Matches scan `source` with scan `target`.
using PairMatcher =
    std::function<Alignment(std::size_t target, std::size_t source, const Pose& guess)>;

/// The same; `first_gate` (m) follows from how far off the guess may be.
using GatedPairMatcher = std::function<Alignment(std::size_t target, std::size_t source,
                                                 const Pose& guess, double first_gate)>;

/// Matches the scan after some earlier ones, whose poses (world_from_scan) are known, with all of
/// them that overlap it. The target of guess and answer is the last of the earlier ones.
using MetascanMatcher =
    std::function<Alignment(std::span<const Pose> earlier, const Pose& guess, double first_gate)>;

/// Match by align(); the scans must outlive them. Errors say which scans.
PairMatcher icp_matcher(std::span<const MatchingScan> scans, const IcpParams& params = {});
GatedPairMatcher icp_gated_matcher(std::span<const MatchingScan> scans,
                                   const IcpParams& params = {});
MetascanMatcher icp_metascan_matcher(std::span<const MatchingScan> scans,
                                     const IcpParams& params = {},
                                     const MetascanParams& metascan = {});

/// Parameters that begin with another gate; 0: with their own.
IcpParams with_first_gate(IcpParams params, double first_gate);

}  // namespace planum
