#include "labeling/rules/leaves.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "labeling/rules/upright.hpp"

namespace planum {
namespace {

constexpr double min_depth = 0.02;     // m behind the face of the wall
constexpr double same_face = 0.04;     // m, parts of one face of a wall
constexpr double beside = 0.3;         // m from a leaf to the wall at its side
constexpr double max_hidden = 0.1;     // m of a leaf that the wall in front may hide
constexpr double max_gap_below = 0.2;  // m from the floor to a leaf
constexpr double door_confidence = 0.7, window_confidence = 0.5;

/// The face of the wall that a leaf is set into: how far it goes beyond the leaf (m).
struct Frame {
  double left = -HUGE_VAL, right = -HUGE_VAL, below = -HUGE_VAL, above = -HUGE_VAL;
};

/// Walls in front of a leaf that look the same way, the nearest first, with the leaf's depth.
std::vector<std::pair<double, std::size_t>> walls_in_front(const LabelScene& scene,
                                                           const std::vector<PolygonLabel>& labels,
                                                           std::size_t leaf, double max_depth) {
  const LevelPolygon& it = scene.polygons[leaf];
  const Eigen::Vector2d run = along(it);
  const Extent own = extent(it, run);
  std::vector<std::pair<double, std::size_t>> walls;
  for (std::size_t j = 0; j < labels.size(); ++j) {
    const LevelPolygon& wall = scene.polygons[j];
    if (j == leaf || labels[j].label != Label::wall || !faces_like(it, wall)) continue;
    const Extent reach = extent(wall, run);
    if (reach.to < own.from - beside || reach.from > own.to + beside) continue;
    const double depth = -wall.plane.signed_distance((it.low + it.high) / 2);
    if (depth >= min_depth && depth <= max_depth) walls.emplace_back(depth, j);
  }
  std::sort(walls.begin(), walls.end());
  return walls;
}

/// Nothing if no wall is in front, or if it is closed there.
std::optional<Frame> frame_of(const LabelScene& scene, const std::vector<PolygonLabel>& labels,
                              std::size_t leaf, double max_depth) {
  const auto walls = walls_in_front(scene, labels, leaf, max_depth);
  if (walls.empty()) return std::nullopt;
  const LevelPolygon& it = scene.polygons[leaf];
  const Extent own = extent(it, along(it));
  const Eigen::Vector3d middle = (it.low + it.high) / 2;
  Frame frame;
  for (const auto& [depth, j] : walls) {
    if (depth > walls.front().first + same_face) break;
    const LevelPolygon& wall = scene.polygons[j];
    if (covers_upright(wall, along(wall).dot(middle.head<2>()), middle.z())) return std::nullopt;
    const Extent reach = extent(wall, along(it));
    frame.left = std::max(frame.left, own.from - reach.from);
    frame.right = std::max(frame.right, reach.to - own.to);
    frame.below = std::max(frame.below, it.low.z() - wall.low.z());
    frame.above = std::max(frame.above, wall.high.z() - it.high.z());
  }
  return frame;
}

}  // namespace

void label_leaves(const LabelScene& scene, const LabelParams& params,
                  std::vector<PolygonLabel>& labels) {
  const std::vector<PolygonLabel> before = labels;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const LevelPolygon& it = scene.polygons[i];
    // What ends at a ceiling is wall, however far back.
    if (it.attitude != Attitude::upright || before[i].confidence > 0.8) continue;
    const double across = width(it), height = it.high.z() - it.low.z();
    if (across > params.max_leaf_width || height > params.max_leaf_height) continue;
    const auto frame = frame_of(scene, before, i, params.max_leaf_depth);
    if (!frame || frame->left < -max_hidden || frame->right < -max_hidden || frame->above < 0)
      continue;
    const Eigen::Vector2d in_front =
        (it.low + it.high).head<2>() / 2 + it.plane.normal.head<2>() * params.max_leaf_depth;
    const auto floor = height_of_floor_below(scene, before, in_front, it.high.z());
    if (!floor) continue;
    const double sill = it.low.z() - *floor;
    if (sill < max_gap_below && across >= params.min_leaf_width && height >= params.min_leaf_height)
      labels[i] = {Label::door, door_confidence};
    else if (sill >= params.min_sill && frame->below > 0 && across >= params.min_pane_size &&
             height >= params.min_pane_size)
      labels[i] = {Label::window, window_confidence};
  }
}

}  // namespace planum
