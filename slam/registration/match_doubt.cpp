#include "slam/registration/match_doubt.hpp"

#include <fmt/format.h>

namespace planum {

std::string doubt_of_match(const Alignment& alignment, double min_overlap) {
  if (alignment.pairs == 0) return "too few pairs";
  if (alignment.overlap < min_overlap)
    return fmt::format("overlap {:.2f} is below {:.2f}", alignment.overlap, min_overlap);
  if (!alignment.converged) return "the match did not converge";
  return {};
}

std::string doubt_of_rays(double contradicted, double most) {
  if (contradicted <= most) return {};
  return fmt::format("rays of one scan go through {:.0f} % of the other's surfaces",
                     100 * contradicted);
}

}  // namespace planum
