#include "slam/registration/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace planum {

double estimated_overlap(const MatchingScan& source, const MatchingScan& target,
                         const Pose& target_from_source, const OverlapParams& params) {
  const auto samples =
      std::span(source.shuffled).first(std::min(params.samples, source.shuffled.size()));
  if (samples.empty()) return 0;
  const float least_cosine = static_cast<float>(std::cos(params.max_normal_angle));
  const Eigen::Matrix3f rotation = target_from_source.linear().cast<float>();
  std::size_t found = 0;
  for (const std::uint32_t s : samples) {
    const Eigen::Vector3d point = target_from_source * source.points[s].cast<double>();
    const auto nearest =
        target.tree.nearest(point.cast<float>(), static_cast<float>(params.distance));
    if (!nearest) continue;
    const LocalPlane &from = source.planes[s], &to = target.planes[nearest->index];
    if (!from.known() || !to.known() || (rotation * from.normal).dot(to.normal) > least_cosine)
      ++found;
  }
  return static_cast<double>(found) / static_cast<double>(samples.size());
}

}  // namespace planum
