#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "meshing/polygon_map.hpp"
#include "slam/core/pose.hpp"

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

struct LabelParams {
  Eigen::Vector3d prior_up = Eigen::Vector3d::UnitZ();  ///< roughly up; the scene says exactly
  double max_tilt = radians(15);  ///< of a floor from level, of a wall from upright
  double same_level = 0.12;       ///< m, surfaces closer in height are one level
  double min_headroom = 1.8;      ///< m, between a floor and what is above it
  double max_raise = 2.6;         ///< m, what is less above a floor beside it may be furniture
  double neighbourhood = 1.0;     ///< m, how far a floor beside furniture is looked for
  double max_raised_share = 0.6;  ///< of a surface with a lower one beside it, to be a floor
  double min_level_area = 0.25;   ///< m^2, smaller surfaces are floor only at the level of one
  double ceiling_gap = 0.25;      ///< m, a wall ends less than this below its ceiling
  double min_wall_height = 1.5;   ///< m, where no ceiling tells what is a wall
  double min_wall_area = 1.5;     ///< m^2, the same
};

/// Floors, ceilings and walls by their normals and their places in the scene (docs/labeling.md):
/// a floor is level and looks up, no lower floor is beside most of it, and a person can stand on
/// it; a ceiling is the same upside down; a wall is upright and ends at a ceiling, or continues one
/// that does, or is large with nothing behind it. Labels stay the same when the scene is moved or
/// turned. Throws Error for parameters out of range.
Labels label(const PolygonMap& map, const LabelParams& params = {});

}  // namespace planum
