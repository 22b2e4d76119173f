#pragma once

#include "slam/graph/loop_candidates.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/pose_graph.hpp"
#include "slam/registration/see_through.hpp"

namespace planum {

/// What a match is compared with.
struct LoopEvidence {
  double usual_rms = 0;        ///< m, of matches along the path; 0: unknown
  const RangeView &from, &to;  ///< of the scans that a candidate joins
};

/// Matches a candidate, from several starts where the path leaves it open by more than the least
/// gate, and tests the match: overlap, rms, agreement with the path, rays of one scan through
/// surfaces of the other, and that no other place fits as well. Not accepted says why.
Edge verified_loop(const LoopCandidate& candidate, const GatedPairMatcher& matcher,
                   const LoopEvidence& evidence, const LoopParams& params);

}  // namespace planum
