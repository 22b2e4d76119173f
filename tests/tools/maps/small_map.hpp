#pragma once

#include <string>

#include "meshing/triangulation.hpp"
#include "tests/labeling/plans.hpp"
#include "tools/maps/labelled_map.hpp"

namespace planum::testing {

/// A labelled map that owns its parts.
struct SmallMap {
  PolygonMap map;
  Labels labels;
  RoomMap rooms;

  LabelledMap labelled() const { return {map, labels, rooms}; }
};

inline constexpr double small_map_volume = 4 * 3 * 2.5 - 1 * 0.8 * 0.7;  ///< m^3, of free space

/// A room of 4 x 3 x 2.5 m with a box on its floor: one closed surface, the top of the box in two
/// triangles that are no polygon. The walls, the floor and the ceiling are of "room 1".
inline SmallMap small_map(const Pose& world_from_room = Pose::Identity()) {
  const auto corner = [](double x, double y, double z) { return Vector3d(x, y, z); };
  PlanMaker plan;
  plan.add("floor", {corner(0, 0, 0), corner(4, 0, 0), corner(4, 3, 0), corner(0, 3, 0)},
           {{corner(1, 1, 0), corner(1, 1.8, 0), corner(2, 1.8, 0), corner(2, 1, 0)}});
  plan.add("ceiling", {corner(0, 0, 2.5), corner(0, 3, 2.5), corner(4, 3, 2.5), corner(4, 0, 2.5)});
  plan.add("wall", {corner(0, 0, 0), corner(0, 0, 2.5), corner(4, 0, 2.5), corner(4, 0, 0)});
  plan.add("wall", {corner(0, 3, 0), corner(4, 3, 0), corner(4, 3, 2.5), corner(0, 3, 2.5)});
  plan.add("wall", {corner(0, 0, 0), corner(0, 3, 0), corner(0, 3, 2.5), corner(0, 0, 2.5)});
  plan.add("wall", {corner(4, 0, 0), corner(4, 0, 2.5), corner(4, 3, 2.5), corner(4, 3, 0)});
  plan.add("unknown", {corner(1, 1, 0), corner(2, 1, 0), corner(2, 1, 0.7), corner(1, 1, 0.7)});
  plan.add("unknown",
           {corner(1, 1.8, 0), corner(1, 1.8, 0.7), corner(2, 1.8, 0.7), corner(2, 1.8, 0)});
  plan.add("unknown", {corner(1, 1, 0), corner(1, 1, 0.7), corner(1, 1.8, 0.7), corner(1, 1.8, 0)});
  plan.add("unknown", {corner(2, 1, 0), corner(2, 1.8, 0), corner(2, 1.8, 0.7), corner(2, 1, 0.7)});

  SmallMap result;
  result.map = plan.moved(world_from_room);
  for (const Vector3d& p :
       {corner(1, 1, 0.7), corner(2, 1, 0.7), corner(2, 1.8, 0.7), corner(1, 1.8, 0.7)})
    result.map.rest.vertices.push_back((world_from_room * p).cast<float>());
  result.map.rest.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const std::string& word : plan.labels) {
    const auto count = static_cast<double>(result.labels.polygons.size());
    for (const Label label : all_labels)
      if (name(label) == word) result.labels.polygons.push_back({label, 1 - count / 16});
  }
  Room room;
  room.name = "room 1";
  room.centre = world_from_room * corner(2, 1.5, 1.25);
  room.area = 12;
  room.width = 3;
  room.depth = 4;
  room.height = 2.5;
  for (const Vector3d& p : {corner(0, 0, 0), corner(4, 0, 0), corner(4, 3, 0), corner(0, 3, 0)})
    room.outline.push_back(world_from_room * p);
  result.rooms.rooms.push_back(room);
  result.rooms.room_of_polygon = {0, 0, 0, 0, 0, 0, -1, -1, -1, -1};
  return result;
}

}  // namespace planum::testing
