#include "labeling/labels.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "labeling/label_scene.hpp"
#include "labeling/rules/floors.hpp"
#include "labeling/rules/furniture.hpp"
#include "labeling/rules/leaves.hpp"
#include "labeling/rules/opening_parts.hpp"
#include "labeling/rules/stairs.hpp"
#include "labeling/rules/walls.hpp"
#include "meshing/up_direction.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

void check(const LabelParams& params) {
  if (!(params.max_tilt > 0 && params.max_tilt < pi / 4))
    throw Error("labels: max_tilt is " + std::to_string(params.max_tilt) +
                " rad, must be above 0 and below 0.785");
  if (!(params.prior_up.norm() > 0)) throw Error("labels: prior_up has no direction");
  const std::pair<const char*, double> lengths[] = {
      {"same_level", params.same_level},
      {"min_headroom", params.min_headroom},
      {"max_raise", params.max_raise},
      {"neighbourhood", params.neighbourhood},
      {"max_raised_share", params.max_raised_share},
      {"min_level_area", params.min_level_area},
      {"min_ceiling_width", params.min_ceiling_width},
      {"max_roof_tilt", params.max_roof_tilt},
      {"ceiling_gap", params.ceiling_gap},
      {"min_wall_height", params.min_wall_height},
      {"min_wall_area", params.min_wall_area},
      {"min_beam_length", params.min_beam_length},
      {"min_rise", params.min_rise},
      {"max_rise", params.max_rise},
      {"min_going", params.min_going},
      {"max_going", params.max_going},
      {"min_step_width", params.min_step_width},
      {"min_stair_slope", params.min_stair_slope},
      {"max_stair_slope", params.max_stair_slope},
      {"min_leaf_width", params.min_leaf_width},
      {"max_leaf_width", params.max_leaf_width},
      {"min_leaf_height", params.min_leaf_height},
      {"max_leaf_height", params.max_leaf_height},
      {"max_leaf_depth", params.max_leaf_depth},
      {"min_sill", params.min_sill},
      {"min_pane_size", params.min_pane_size},
      {"min_furniture_height", params.min_furniture_height},
      {"max_furniture_height", params.max_furniture_height},
      {"max_gap_to_floor", params.max_gap_to_floor}};
  for (const auto& [option, value] : lengths)
    if (!(value >= 0))
      throw Error("labels: " + std::string(option) + " is " + std::to_string(value) +
                  ", must be at least 0");
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
  std::vector<PolygonLabel>& polygons = labels.polygons;
  polygons.assign(map.polygons.size(), {Label::unknown, 1});
  label_floors(scene, params, polygons);
  label_ceilings(scene, params, polygons);
  label_roofs(scene, params, polygons);
  label_walls(scene, params, polygons);
  label_wall_ends(scene, params, polygons);
  label_soffits(scene, params, polygons);
  label_stairs(scene, params, polygons);
  label_flights(scene, params, polygons);
  label_leaves(scene, params, polygons);
  label_furniture_tops(scene, params, polygons);
  label_furniture_sides(scene, params, polygons);
  return labels;
}

Labels with_openings(const PolygonMap& map, Labels labels, std::span<const Opening> openings) {
  if (labels.polygons.size() != map.polygons.size())
    throw Error("labels: " + std::to_string(map.polygons.size()) + " polygons with " +
                std::to_string(labels.polygons.size()) + " labels");
  label_frames(map, openings, labels.polygons);
  label_open_leaves(map, openings, labels.polygons);
  return labels;
}

}  // namespace planum
