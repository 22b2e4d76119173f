#include "slam/registration/metascan.hpp"

#include <algorithm>

#include "slam/registration/overlap.hpp"

namespace planum {

std::vector<std::size_t> metascan_members(std::span<const MatchingScan> scans,
                                          std::span<const Pose> earlier, const Pose& guess,
                                          const MetascanParams& params) {
  if (earlier.empty()) return {};
  const MatchingScan& source = scans[earlier.size()];
  const Pose world_from_source = earlier.back() * guess;
  const OverlapParams near{.distance = 0.5};
  std::vector<double> overlap(earlier.size(), 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < earlier.size(); ++i) {
    const Pose scan_from_source = earlier[i].inverse() * world_from_source;
    if (scan_from_source.translation().norm() > params.max_distance) continue;
    overlap[i] = estimated_overlap(source, scans[i], scan_from_source, near);
    if (overlap[i] >= params.min_overlap) order.push_back(i);
  }
  // Of equal ones the later: it is better known how it lies.
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return overlap[a] != overlap[b] ? overlap[a] > overlap[b] : a > b;
  });
  order.resize(std::min(order.size(), params.scans));
  std::sort(order.begin(), order.end());
  return order;
}

MatchingScan metascan_of(std::span<const MatchingScan> scans, std::span<const Pose> earlier,
                         std::span<const std::size_t> members) {
  std::vector<PlacedScan> placed;
  for (const std::size_t i : members)
    placed.push_back({&scans[i], earlier.back().inverse() * earlier[i]});
  return merged(placed);
}

}  // namespace planum
