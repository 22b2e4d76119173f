#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "labeling/labels.hpp"
#include "labeling/plan/floor_grid.hpp"
#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// What a robot may find in a cell.
enum class Occupancy : std::uint8_t { unknown, free, occupied };

/// A floor plan for robots. The grid's axes are those of the world; only its corner is elsewhere.
struct OccupancyGrid {
  FloorGrid grid;
  double floor = 0;              ///< m, height of the storey's floor in the world
  std::vector<Occupancy> cells;  ///< row by row from the lowest y, columns from the lowest x

  /// Where the outer corner of the first cell is in the world (m).
  Eigen::Vector2d corner() const { return -grid.plan_from_world.translation().head<2>(); }
};

struct OccupancyParams {
  double cell = 0.05;        ///< m
  double low = 0.1;          ///< m above the floor, what is lower a robot drives over
  double high = 1.5;         ///< m above the floor, what is higher it drives under
  double free_height = 0.4;  ///< m above `low`, rays have to pass below that to say free: what is
                             ///< above a cupboard is no way
  double end_margin = 0.1;   ///< m, the last part of a ray is not called free
  double min_hits = 2;       ///< points in an occupied cell, at least
  double min_hit_share = 0.05;    ///< of the rays that came into it, at least
  std::size_t max_rays = 600000;  ///< rays that say what is free; all points say what is not
};

/// What is in the way of a body between `low` and `high` above a floor. Occupied cells hold surface
/// at these heights: of the mesh, or so many points that they are no noise, such as poles too thin
/// for the mesh. Points without normals (strays, and what other scans look through) do not count.
/// Free cells had rays near their floor; all others are unknown.
///
/// `cloud` is in a levelled world, with normals and a `scan` index into `scan_origins` (which may
/// be missing if there is one). Throws Error without normals or origins, and for parameters out of
/// range. A cloud without surface gives a grid without cells. The same for any number of threads.
OccupancyGrid occupancy_grid(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                             const TriangleMesh& mesh, double floor,
                             const OccupancyParams& params = {});

/// Heights of the floors of a levelled map, lowest first: floor polygons that differ by less than
/// `min_storey` (m) are one storey, at the height of most of its area; storeys with less than
/// `min_area` (m^2) of floor are left out.
std::vector<double> storey_floors(const PolygonMap& map, const Labels& labels,
                                  double min_storey = 1.8, double min_area = 2);

}  // namespace planum
