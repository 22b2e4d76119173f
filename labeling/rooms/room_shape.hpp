#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/rooms/level_surfaces.hpp"
#include "labeling/rooms/room_outline.hpp"

namespace planum {

/// A room's measures in the plan frame.
struct RoomShape {
  RoomOutline outline;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< m, of the box width x depth
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< unit, the direction of the depth
  double area = 0;                                   ///< m^2
  double width = 0, depth = 0;                       ///< m, between opposite walls, width <= depth
  double floor = 0, ceiling = 0;                     ///< m, z
  double floor_share = 0, ceiling_share = 0;         ///< of the area where they were seen
};

/// Measures one region. Width and depth are distances between the outermost large wall faces along
/// the room's own main directions; where no face was seen, the outline's extent stands in.
RoomShape measure_room(const FloorGrid& grid, const RoomRegions& regions, std::size_t region,
                       const std::vector<RegionFace>& own_faces, const std::vector<WallFace>& faces,
                       const CellMask& wall, const LevelSurface& floor,
                       const LevelSurface& ceiling);

}  // namespace planum
