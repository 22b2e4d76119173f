#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "labeling/labels.hpp"
#include "labeling/objects/oriented_box.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/polygon_map.hpp"

namespace planum {

/// The points of an object, cell by cell.
struct ObjectCells {
  std::vector<Eigen::Vector3d> points;  ///< m
  std::vector<std::size_t> first;       ///< of each cell in `points`, and the end of the last
};

/// The box round cells: its direction is that of a rectangle round their middles, and `max_stray`
/// of them may be outside of each face.
OrientedBox box_round(const ObjectCells& cells, double max_stray);

/// The same box with sides that are nearer to a parallel wall than `reach` (m) moved to it: points
/// there belong to the wall.
OrientedBox reaching_walls(const OrientedBox& box, const Room& room, double reach);

/// Polygons that are no part of the building and have their corners in a box, give or take
/// `margin` (m).
std::vector<std::uint32_t> polygons_in(const OrientedBox& box, const PolygonMap& map,
                                       const Labels& labels, double margin);

}  // namespace planum
