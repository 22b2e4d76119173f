#include "slam/evaluation/relations.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/evaluation/pose_matching.hpp"

namespace planum {
namespace {

/// Calls visit(i, j) for all pairs of poses that relations are wanted of.
template <class Visit>
void visit_pairs(const Trajectory& truth, double max_distance, const Visit& visit) {
  for (std::size_t i = 0; i + 1 < truth.size(); ++i) {
    if (max_distance == 0) {
      visit(i, i + 1);
      continue;
    }
    for (std::size_t j = i + 1; j < truth.size(); ++j)
      if ((truth[j].pose.translation() - truth[i].pose.translation()).norm() <= max_distance)
        visit(i, j);
  }
}

/// Poses by their stamps.
class StampIndex {
 public:
  explicit StampIndex(const Trajectory& trajectory) : sorted_(trajectory) {
    std::stable_sort(sorted_.begin(), sorted_.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  }

  const Pose* nearest(double stamp, double max_difference) const {
    const auto above =
        std::lower_bound(sorted_.begin(), sorted_.end(), stamp,
                         [](const StampedPose& pose, double s) { return pose.stamp < s; });
    const StampedPose* best = nullptr;
    for (auto at = above == sorted_.begin() ? above : above - 1; at != sorted_.end(); ++at) {
      if (!best || std::abs(at->stamp - stamp) < std::abs(best->stamp - stamp)) best = &*at;
      if (at == above) break;
    }
    if (!best || std::abs(best->stamp - stamp) > max_difference) return nullptr;
    return &best->pose;
  }

 private:
  Trajectory sorted_;
};

void check(std::span<const Relation> relations) {
  for (std::size_t k = 0; k < relations.size(); ++k)
    if (!std::isfinite(relations[k].from) || !std::isfinite(relations[k].to) ||
        !relations[k].from_from_to.matrix().allFinite())
      throw Error(fmt::format("evaluation: relation {} is not finite", k));
}

}  // namespace

std::vector<Relation> relations_of(const Trajectory& truth, const RelationParams& params) {
  if (!(params.max_distance >= 0))
    throw Error(
        fmt::format("evaluation: max_distance must be >= 0 m, got {}", params.max_distance));
  check_finite(truth, "truth");
  std::size_t count = 0;
  visit_pairs(truth, params.max_distance, [&](std::size_t, std::size_t) { ++count; });
  const std::size_t wanted = params.max_count == 0 ? count : std::min(count, params.max_count);
  std::vector<Relation> relations;
  std::size_t k = 0;
  visit_pairs(truth, params.max_distance, [&](std::size_t i, std::size_t j) {
    // Pair k is taken where k wanted / count steps to the next whole number.
    if (k++ * wanted / count < relations.size()) return;
    relations.push_back({.from = truth[i].stamp,
                         .to = truth[j].stamp,
                         .from_from_to = truth[i].pose.inverse() * truth[j].pose});
  });
  return relations;
}

RelationError relation_error(const Trajectory& estimate, std::span<const Relation> relations,
                             double max_stamp_difference) {
  if (!(max_stamp_difference >= 0))
    throw Error(
        fmt::format("evaluation: max_stamp_difference must be >= 0, got {}", max_stamp_difference));
  check_finite(estimate, "estimate");
  check(relations);
  const StampIndex poses(estimate);
  RelationError result;
  std::vector<double> translations, rotations;
  for (const Relation& relation : relations) {
    const Pose* from = poses.nearest(relation.from, max_stamp_difference);
    const Pose* to = poses.nearest(relation.to, max_stamp_difference);
    if (!from || !to) {
      ++result.unknown;
      continue;
    }
    const Pose error = relation.from_from_to.inverse() * from->inverse() * *to;
    translations.push_back(error.translation().norm());
    rotations.push_back(degrees(rotation_angle(error)));
  }
  if (translations.empty())
    throw Error(
        fmt::format("evaluation: none of the {} relations is of two poses that the trajectory has",
                    relations.size()));
  result.translation = statistics(translations);
  result.rotation = statistics(rotations);
  for (double& e : translations) e *= e;
  for (double& e : rotations) e *= e;
  result.squared_translation = statistics(translations);
  result.squared_rotation = statistics(rotations);
  return result;
}

}  // namespace planum
