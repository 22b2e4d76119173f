#pragma once

#include <Eigen/Core>

#include "slam/core/pose.hpp"

namespace planum {

/// All that the rules know of buildings, to be adapted to a factory or a mine: docs/labeling.md
/// has the source of each value, the project file a key for it.
struct LabelParams {
  Eigen::Vector3d prior_up = Eigen::Vector3d::UnitZ();  ///< roughly up; the scene says exactly
  double max_tilt = radians(15);  ///< of a floor from level, of a wall from upright

  // Floors and ceilings.
  double same_level = 0.12;            ///< m, surfaces closer in height are one level
  double min_headroom = 1.8;           ///< m, between a floor and what is above it
  double max_raise = 2.6;              ///< m, what is less above a floor beside it may be furniture
  double neighbourhood = 1.0;          ///< m, how far a floor beside furniture is looked for
  double max_raised_share = 0.6;       ///< of a surface with a lower one beside it, to be a floor
  double min_level_area = 0.25;        ///< m^2, smaller surfaces are floor only at the level of one
  double min_ceiling_width = 0.7;      ///< m, a narrower underside is a beam's or a lintel's
  double max_roof_tilt = radians(60);  ///< from level, of the underside of a pitched roof

  // Walls.
  double ceiling_gap = 0.25;     ///< m, a wall ends less than this below its ceiling
  double min_wall_height = 1.5;  ///< m, where no ceiling tells what is a wall
  double min_wall_area = 1.5;    ///< m^2, the same
  double min_beam_length = 1.0;  ///< m, of what hangs above headroom and is part of a wall

  // Stairs.
  double min_rise = 0.10, max_rise = 0.24;                              ///< m, from step to step
  double min_going = 0.15, max_going = 0.60;                            ///< m, depth of a step
  double min_step_width = 0.5;                                          ///< m
  double min_stair_slope = radians(18), max_stair_slope = radians(45);  ///< of a whole flight

  // Doors and windows that do not open a hole in the cloud.
  double min_leaf_width = 0.55, max_leaf_width = 2.2;   ///< m, of one door or a pair of doors
  double min_leaf_height = 1.8, max_leaf_height = 2.4;  ///< m
  double max_leaf_depth = 0.45;                         ///< m, behind the face of its wall
  double min_sill = 0.3;                                ///< m above the floor, of a window
  double min_pane_size = 0.4;                           ///< m, of a window

  // Furniture.
  double min_furniture_height = 0.15, max_furniture_height = 2.2;  ///< m above the floor, of tops
  double max_gap_to_floor = 0.35;  ///< m, legs: furniture begins at most this far above its floor
};

}  // namespace planum
