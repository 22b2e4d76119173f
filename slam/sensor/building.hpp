#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/triangle_mesh.hpp"
#include "slam/sensor/plan_polygon.hpp"

namespace planum {

/// A room: what its walls enclose in plan, from the floor (z = 0) to its own ceiling.
struct RoomPlan {
  std::string name;
  PlanPolygon walls;    ///< inner faces; a hole is a pillar, or the core that a corridor goes round
  double height = 2.6;  ///< m
};

/// A passage through the wall between two rooms; what lies between their wall faces is the wall.
struct DoorPlan {
  std::array<std::string, 2> between;
  Eigen::Vector2d centre;  ///< m, anywhere in the wall: the nearest wall face of each room is cut
  double width = 0.9;      ///< m
  double height = 2.0;     ///< m
};

/// An opening from a room to the outside.
struct WindowPlan {
  std::string room;
  Eigen::Vector2d centre;  ///< m, the nearest wall face of the room is cut
  double width = 1.2;      ///< m
  double height = 1.3;     ///< m
  double sill = 0.9;       ///< m above the floor
};

/// A part of a piece of furniture; see furniture.hpp.
struct Box {
  Eigen::Vector3d base;  ///< m, the centre of its underside
  Eigen::Vector3d size;  ///< m
  double turn = 0;       ///< rad about z
};

/// A storey, drawn. Walls may run in any direction.
struct BuildingPlan {
  std::string name = "building";
  std::vector<RoomPlan> rooms = {};
  std::vector<DoorPlan> doors = {};
  std::vector<WindowPlan> windows = {};
  std::vector<Box> furniture = {};
  double outer_wall = 0.3;  ///< m, thickness at windows
  double turn = 0;          ///< rad, the finished building is turned about z
};

/// What a map of a room is compared with.
struct TrueRoom {
  std::string name;
  double width = 0;        ///< m, shorter side of the smallest rectangle round the room
  double depth = 0;        ///< m, its longer side
  double height = 0;       ///< m
  double area = 0;         ///< m^2 of floor
  Eigen::Vector2d centre;  ///< m, of the rectangle
};

/// What a map of a door is compared with.
struct TrueDoor {
  std::array<std::string, 2> between;
  double width = 0;        ///< m
  double height = 0;       ///< m
  Eigen::Vector3d centre;  ///< m, in the middle of the wall and of the height
};

/// A storey, built: the surfaces that face free space, and true figures in the same frame.
struct Building {
  std::string name;
  double turn = 0;         ///< rad
  LabelledMesh mesh = {};  ///< groups floor, ceiling, wall, jamb, lintel, window, clutter
  std::vector<TrueRoom> rooms = {};
  std::vector<TrueDoor> doors = {};
};

/// Builds a plan. The rooms' surfaces form one mesh that is closed but for the windows' outer rims;
/// each box of furniture is a closed mesh of its own. Throws Error if a room is named that is not
/// there, or a door or window does not fit its walls.
Building built(const BuildingPlan& plan);

}  // namespace planum
