#include "labeling/rooms/polygon_rooms.hpp"

#include <algorithm>
#include <cmath>

#include "labeling/plan/plan_ring.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr double probe_distance = 0.12;  // m before the polygon, into free space
constexpr double level_margin = 0.25;    // m below the floor and above the ceiling
constexpr double samples_per_side = 20;  // of the polygon's bounding box in its plane

/// A polygon in its own plane.
struct FlatPolygon {
  Eigen::Vector3d origin, x, y;
  std::vector<std::vector<Eigen::Vector2d>> rings;
  Eigen::Vector2d low, high;
};

std::vector<Eigen::Vector2d> flattened(const Ring& ring, const PolygonMap& map,
                                       const FlatPolygon& frame) {
  std::vector<Eigen::Vector2d> result;
  for (const std::uint32_t v : ring) {
    const Eigen::Vector3d d = map.vertices[v] - frame.origin;
    result.emplace_back(frame.x.dot(d), frame.y.dot(d));
  }
  return result;
}

FlatPolygon flat(const MapPolygon& polygon, const PolygonMap& map) {
  FlatPolygon result;
  const Eigen::Vector3d& n = polygon.plane.normal;
  result.origin = map.vertices[polygon.outer.front()];
  result.x = (std::abs(n.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX())
                 .cross(n)
                 .normalized();
  result.y = n.cross(result.x);
  result.rings.push_back(flattened(polygon.outer, map, result));
  for (const Ring& hole : polygon.holes) result.rings.push_back(flattened(hole, map, result));
  result.low = result.high = result.rings.front().front();
  for (const Eigen::Vector2d& p : result.rings.front()) {
    result.low = result.low.cwiseMin(p);
    result.high = result.high.cwiseMax(p);
  }
  return result;
}

bool inside(const FlatPolygon& polygon, const Eigen::Vector2d& p) {
  bool result = false;
  for (const std::vector<Eigen::Vector2d>& ring : polygon.rings)
    result = result != ring_contains(ring, p);
  return result;
}

std::int32_t region_of(const MapPolygon& polygon, const PolygonMap& map, const FloorGrid& grid,
                       const RoomRegions& regions, const std::vector<RegionLevels>& levels) {
  if (polygon.outer.size() < 3) return -1;
  const FlatPolygon shape = flat(polygon, map);
  const Eigen::Vector2d step = (shape.high - shape.low) / samples_per_side;
  std::vector<std::size_t> votes(regions.count, 0);
  std::size_t samples = 0;
  for (int row = 0; row < static_cast<int>(samples_per_side); ++row)
    for (int column = 0; column < static_cast<int>(samples_per_side); ++column) {
      const Eigen::Vector2d p =
          shape.low + Eigen::Vector2d((column + 0.5) * step.x(), (row + 0.5) * step.y());
      if (!inside(shape, p)) continue;
      ++samples;
      const Eigen::Vector3d world =
          shape.origin + p.x() * shape.x + p.y() * shape.y + probe_distance * polygon.plane.normal;
      const Eigen::Vector3d plan = grid.plan_from_world * world;
      const std::ptrdiff_t cell = grid.find(plan.head<2>());
      if (cell < 0) continue;
      const std::int32_t region = regions.of_cell[static_cast<std::size_t>(cell)];
      if (region < 0) continue;
      const RegionLevels& level = levels[static_cast<std::size_t>(region)];
      if (plan.z() > level.floor - level_margin && plan.z() < level.ceiling + level_margin)
        ++votes[static_cast<std::size_t>(region)];
    }
  const auto most = std::max_element(votes.begin(), votes.end());
  if (most == votes.end() || 2 * *most <= samples) return -1;
  return static_cast<std::int32_t>(most - votes.begin());
}

}  // namespace

std::vector<std::int32_t> regions_of_polygons(const PolygonMap& map, const FloorGrid& grid,
                                              const RoomRegions& regions,
                                              const std::vector<RegionLevels>& levels) {
  std::vector<std::int32_t> result(map.polygons.size(), -1);
  parallel_for(map.polygons.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result[i] = region_of(map.polygons[i], map, grid, regions, levels);
  });
  return result;
}

}  // namespace planum
