#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "labeling/label_params.hpp"
#include "labeling/rooms/openings.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// What a polygon is a part of. The numbers are those of `label` in map.ply: they stay.
enum class Label {
  unknown,
  floor,
  ceiling,
  wall,
  door,                  ///< jambs, lintels and thresholds of doors and passages, and door leaves
  window,                ///< sills, reveals and panes of windows
  stair,                 ///< treads and risers, and single steps
  furniture_horizontal,  ///< tops of tables and cupboards, shelves, seats, and their undersides
  furniture_vertical,    ///< sides of what stands on the floor and is no wall
};

inline constexpr std::array all_labels = {Label::unknown,
                                          Label::floor,
                                          Label::ceiling,
                                          Label::wall,
                                          Label::door,
                                          Label::window,
                                          Label::stair,
                                          Label::furniture_horizontal,
                                          Label::furniture_vertical};

/// As in polygons.json: "unknown", "floor", "furniture_horizontal" ...
const char* name(Label label);

struct PolygonLabel {
  Label label = Label::unknown;
  double confidence = 0;  ///< in [0, 1]; of `unknown` too: how sure it is no floor, ceiling or wall
};

struct Labels {
  std::vector<PolygonLabel> polygons;             ///< in the order of the map
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit, against gravity, as the scene shows it
  double up_confidence = 0;                       ///< in [0, 1]
};

/// What each polygon is by its normal and its place in the scene (docs/labeling.md). The rules, in
/// labeling/rules, run one after the other: floors, ceilings, walls, stairs, doors and windows that
/// are closed, furniture; what none of them knows is `unknown`. Labels stay the same when the scene
/// is moved or turned. Throws Error for parameters out of range.
Labels label(const PolygonMap& map, const LabelParams& params = {});

/// The same labels after openings were found (find_rooms): frames, sills and leaves in and beside
/// them become `door` and `window`. The map must be level.
Labels with_openings(const PolygonMap& map, Labels labels, std::span<const Opening> openings);

}  // namespace planum
