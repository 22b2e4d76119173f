#include "labeling/keepout.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "labeling/plan/plan_ring.hpp"
#include "meshing/plane_geometry.hpp"
#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

/// Calls visit(cell, height) for every cell whose middle a polygon covers.
template <typename Visit>
void for_each_covered_cell(const MapPolygon& polygon, const PolygonMap& map, const FloorGrid& grid,
                           Visit&& visit) {
  std::vector<Ring2d> rings;
  const auto add = [&](const Ring& ring) {
    rings.emplace_back();
    for (const std::uint32_t v : ring)
      rings.back().push_back((grid.plan_from_world * map.vertices[v]).head<2>());
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
  Eigen::Vector2d low = rings.front().front(), high = low;
  for (const Eigen::Vector2d& p : rings.front()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Pose world_from_plan = grid.plan_from_world.inverse();
  for (int row = std::max(0, grid.row_of(low.y()));
       row <= std::min(grid.rows - 1, grid.row_of(high.y())); ++row)
    for (int column = std::max(0, grid.column_of(low.x()));
         column <= std::min(grid.columns - 1, grid.column_of(high.x())); ++column) {
      const std::size_t cell = grid.index(column, row);
      const Eigen::Vector2d middle = grid.centre(cell);
      if (!rings_contain(rings, middle)) continue;
      const Eigen::Vector3d place = world_from_plan * Eigen::Vector3d(middle.x(), middle.y(), 0);
      const Plane& plane = polygon.plane;
      visit(cell, (plane.offset - plane.normal.head<2>().dot(place.head<2>())) / plane.normal.z());
    }
}

void check(const PolygonMap& map, const Labels& labels, const KeepoutParams& params) {
  if (labels.polygons.size() != map.polygons.size())
    throw Error("keep-out mask: " + std::to_string(map.polygons.size()) + " polygons with " +
                std::to_string(labels.polygons.size()) + " labels");
  if (!(params.max_step >= 0))
    throw Error("keep-out mask: max_step is " + std::to_string(params.max_step) +
                " m, must be at least 0");
  if (!(params.max_slope > 0 && params.max_slope < pi / 2))
    throw Error("keep-out mask: max_slope is " + std::to_string(params.max_slope) +
                " rad, must be between 0 and 1.57");
}

}  // namespace

OccupancyGrid keepout_mask(const PolygonMap& map, const Labels& labels, const OccupancyGrid& storey,
                           const KeepoutParams& params) {
  check(map, labels, params);
  OccupancyGrid mask{.grid = storey.grid, .floor = storey.floor, .cells = {}};
  mask.cells.assign(mask.grid.size(), Occupancy::unknown);
  std::vector<std::uint8_t> drop(mask.grid.size(), 0), stair(drop), floor(drop);
  const double least_upright = std::cos(params.max_slope);
  for (std::size_t i = 0; i < map.polygons.size(); ++i) {
    const Label label = labels.polygons[i].label;
    if (map.polygons[i].plane.normal.z() < least_upright ||
        (label != Label::floor && label != Label::stair))
      continue;
    for_each_covered_cell(map.polygons[i], map, mask.grid, [&](std::size_t cell, double height) {
      const double above = height - storey.floor;
      if (above > params.stair_headroom) return;
      if (label == Label::stair)
        stair[cell] = 1;
      else
        (above < -params.max_step ? drop : floor)[cell] = 1;
    });
  }
  for (std::size_t cell = 0; cell < mask.cells.size(); ++cell) {
    if (stair[cell] || (drop[cell] && !floor[cell]))
      mask.cells[cell] = Occupancy::occupied;
    else if (floor[cell])
      mask.cells[cell] = Occupancy::free;
  }
  return mask;
}

}  // namespace planum
