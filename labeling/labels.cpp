#include "labeling/labels.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "labeling/label_scene.hpp"
#include "labeling/level_labels.hpp"
#include "labeling/wall_labels.hpp"
#include "meshing/up_direction.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(const LabelParams& params) {
  if (!(params.max_tilt > 0 && params.max_tilt < pi / 4))
    throw Error("labels: max_tilt is " + std::to_string(params.max_tilt) +
                " rad, must be above 0 and below 0.785");
  if (!(params.prior_up.norm() > 0)) throw Error("labels: prior_up has no direction");
  const auto not_negative = [](const char* option, double value) {
    if (!(value >= 0))
      throw Error("labels: " + std::string(option) + " is " + std::to_string(value) +
                  ", must be at least 0");
  };
  not_negative("same_level", params.same_level);
  not_negative("min_headroom", params.min_headroom);
  not_negative("max_raise", params.max_raise);
  not_negative("neighbourhood", params.neighbourhood);
  not_negative("max_raised_share", params.max_raised_share);
  not_negative("min_level_area", params.min_level_area);
  not_negative("ceiling_gap", params.ceiling_gap);
  not_negative("min_wall_height", params.min_wall_height);
  not_negative("min_wall_area", params.min_wall_area);
}

/// Empty if too little of the map is level.
std::optional<UpDirection> up_of(const PolygonMap& map, const Eigen::Vector3d& prior) {
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> areas;
  for (const MapPolygon& polygon : map.polygons) {
    normals.push_back(polygon.plane.normal.cast<float>());
    areas.push_back(static_cast<float>(polygon.area));
  }
  return estimate_up(normals, areas, prior);
}

/// Labels the surfaces of one attitude whose doubt is small, if they are large or at the level of
/// large ones.
void label_levels(const LabelScene& scene, Attitude attitude, Label label,
                  const std::vector<double>& doubts, const LabelParams& params,
                  std::vector<PolygonLabel>& labels) {
  const auto is_at_a_level = [&](std::size_t i) {
    const LevelPolygon& it = scene.polygons[i];
    if (it.area >= params.min_level_area) return true;
    return std::any_of(
        scene.polygons.begin(), scene.polygons.end(), [&](const LevelPolygon& other) {
          const auto j = static_cast<std::size_t>(&other - scene.polygons.data());
          return other.attitude == attitude && other.area >= params.min_level_area &&
                 doubts[j] <= params.max_raised_share &&
                 std::abs(other.middle_height() - it.middle_height()) < params.same_level;
        });
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (scene.polygons[i].attitude != attitude) continue;
    const double slope = 0.5 * scene.polygons[i].tilt / params.max_tilt;
    if (doubts[i] <= params.max_raised_share && is_at_a_level(i))
      labels[i] = {label, (1 - slope) * (1 - 0.5 * doubts[i])};
    else
      labels[i] = {Label::unknown, std::max(0.5, doubts[i])};
  }
}

}  // namespace

const char* name(Label label) {
  switch (label) {
    case Label::floor:
      return "floor";
    case Label::ceiling:
      return "ceiling";
    case Label::wall:
      return "wall";
    case Label::door:
      return "door";
    case Label::window:
      return "window";
    case Label::stair:
      return "stair";
    case Label::furniture_horizontal:
      return "furniture_horizontal";
    case Label::furniture_vertical:
      return "furniture_vertical";
    case Label::unknown:
      break;
  }
  return "unknown";
}

Labels label(const PolygonMap& map, const LabelParams& params) {
  check(params);
  Labels labels;
  labels.up = params.prior_up.normalized();
  if (const auto up = up_of(map, labels.up)) {
    labels.up = up->up;
    labels.up_confidence = up->confidence;
  }
  const LabelScene scene = label_scene(map, labels.up, params.max_tilt);
  labels.polygons.assign(map.polygons.size(), {Label::unknown, 1});
  label_levels(scene, Attitude::facing_up, Label::floor, floor_doubts(scene, params), params,
               labels.polygons);
  label_levels(scene, Attitude::facing_down, Label::ceiling,
               floor_doubts(upside_down(scene), params), params, labels.polygons);
  label_walls(map, scene, params, labels.polygons);
  return labels;
}

}  // namespace planum
