#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "labeling/rooms/free_space.hpp"
#include "labeling/rooms/level_surfaces.hpp"
#include "labeling/rooms/opening_search.hpp"
#include "labeling/rooms/openings.hpp"
#include "labeling/rooms/room_regions.hpp"
#include "labeling/rooms/wall_faces.hpp"
#include "labeling/rooms/wall_gaps.hpp"
#include "labeling/rooms/wall_points.hpp"
#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// A space enclosed by walls, a floor and a ceiling.
struct Room {
  std::string name;  ///< "room 1" is that of the first scan taken in a room
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, of the box width x depth x height
  Eigen::Vector3d along = Eigen::Vector3d::UnitX();  ///< unit, horizontal, direction of the depth
  double area = 0;                       ///< m^2 of the floor plan, as far as it was seen
  double width = 0, depth = 0;           ///< m, between opposite walls, width <= depth
  double height = 0;                     ///< m, from the floor to the largest part of the ceiling
  std::vector<Eigen::Vector3d> outline;  ///< m, on the floor, counter-clockwise seen from above
  std::vector<std::size_t> scans;        ///< those that were taken in it
  std::size_t storey = 0;                ///< position in RoomMap::storeys
};

/// The rooms of a building and how they hang together.
struct RoomMap {
  std::vector<double> storeys;  ///< m, heights of their floors, lowest first
  std::vector<Room> rooms;
  std::vector<Opening> openings;              ///< Opening::rooms are positions in `rooms`
  std::vector<std::int32_t> room_of_polygon;  ///< for each polygon of the map its room, or -1
};

struct RoomParams {
  double cell = 0.05;                ///< m, of the grid over the floor plan
  double min_clearance = 1.6;        ///< m between a floor and what may be its ceiling
  double ceiling_reach = 0.75;       ///< m, free space farther from any seen ceiling is outside
  double min_seen = 0.15;            ///< share of a room's floor and of its ceiling that was seen
  double min_seen_unvisited = 0.25;  ///< the same for rooms without a scan
  LevelSurfaceParams levels = {};
  WallPointParams wall_points = {};
  WallFaceParams walls = {};
  WallGapParams wall_gaps = {};
  RayParams rays = {};
  RoomRegionParams regions = {};
  OpeningSearchParams search = {};
  OpeningParams openings = {};
};

/// Finds rooms, doors and windows in a levelled world (z is up; any yaw): walls are closed curves
/// just below the ceiling, above doors and furniture, and the free space falls apart there; a place
/// where rays went through a wall is an opening. See docs/rooms.md.
/// `cloud` has normals and a `scan` index into `scan_origins`. A cloud that shows no floor or no
/// room gives an empty result. Throws Error for parameters out of range and for a cloud without
/// normals or scan indices.
RoomMap find_rooms(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                   const PolygonMap& map, const RoomParams& params = {});

}  // namespace planum
