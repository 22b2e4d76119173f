#pragma once

#include <cstddef>
#include <vector>

#include "labeling/labels.hpp"
#include "labeling/objects/scene_object.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

struct ObjectParams {
  double clearance = 0.05;  ///< m, what is nearer to the building belongs to it
  double cell = 0.05;       ///< m, points are gathered in cells of this edge
  double max_gap = 0.10;    ///< m, between cells of one object
  double min_size = 0.25;   ///< m, of the longest edge of the box
  std::size_t min_points = 100;
  std::size_t min_cells = 20;
  double max_stray = 0.01;  ///< share of cells that may be outside of each face of the box
  double floor_gap = 0.20;  ///< m, what begins lower than this stands on the floor
};

/// What is left of a cloud once floors, walls, ceilings, doors, windows and stairs are taken:
/// points inside a room that hang together, in order of rooms and, in a room, of their number. A
/// room reaches from its floor to its ceiling and as far as its outline. The cloud has normals;
/// points whose normal is zero do not count. The world is level (z is up). Throws Error for
/// parameters out of range, for a cloud without normals and for labels that are not those of the
/// map.
std::vector<SceneObject> find_objects(const Cloud& cloud, const PolygonMap& map,
                                      const Labels& labels, const RoomMap& rooms,
                                      const ObjectParams& params = {});

}  // namespace planum
