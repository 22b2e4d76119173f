#include "labeling/objects/objects.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "labeling/objects/object_shape.hpp"
#include "labeling/objects/structure_search.hpp"
#include "labeling/plan/plan_ring.hpp"
#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

void check(const Cloud& cloud, const PolygonMap& map, const Labels& labels,
           const ObjectParams& params) {
  const auto fail = [](const std::string& what) { throw Error("objects: " + what); };
  const auto check_length = [&](const char* option, double value, double least) {
    if (!(value >= least && value <= 10))
      fail(fmt::format("{} is {} m, must be {} to 10", option, value, least));
  };
  check_length("clearance", params.clearance, 0.005);
  check_length("cell", params.cell, 0.005);
  check_length("max_gap", params.max_gap, 0);
  check_length("min_size", params.min_size, 0);
  check_length("floor_gap", params.floor_gap, 0);
  if (!(params.max_stray >= 0 && params.max_stray < 0.25))
    fail(fmt::format("max_stray is {}, must be 0 to 0.25", params.max_stray));
  if (cloud.normals.size() != cloud.points.size()) fail("the cloud needs a normal for each point");
  if (labels.polygons.size() != map.polygons.size())
    fail(fmt::format("{} polygons with {} labels", map.polygons.size(), labels.polygons.size()));
}

double floor_of(const Room& room) {
  return room.outline.empty() ? room.centre.z() - room.height / 2 : room.outline[0].z();
}

Eigen::AlignedBox3d bounds_of(const RoomMap& rooms) {
  Eigen::AlignedBox3d bounds;
  for (const Room& room : rooms.rooms)
    for (const Eigen::Vector3d& p : room.outline) {
      bounds.extend(p);
      bounds.extend(p + room.height * Eigen::Vector3d::UnitZ());
    }
  return bounds;
}

/// The rooms as rings in plan, for questions which one a place is in.
struct RoomRings {
  explicit RoomRings(const RoomMap& rooms) {
    for (const Room& room : rooms.rooms) {
      rings.emplace_back();
      for (const Eigen::Vector3d& p : room.outline) rings.back().push_back(p.head<2>());
      heights.emplace_back(floor_of(room), floor_of(room) + room.height);
    }
  }
  /// Its position, or -1.
  std::int32_t room_at(const Eigen::Vector3d& p, double clearance) const {
    for (std::size_t i = 0; i < rings.size(); ++i)
      if (p.z() > heights[i].first + clearance && p.z() < heights[i].second - clearance &&
          ring_contains(rings[i], p.head<2>()))
        return static_cast<std::int32_t>(i);
    return -1;
  }

  std::vector<std::vector<Eigen::Vector2d>> rings;
  std::vector<std::pair<double, double>> heights;  ///< m, of floor and ceiling
};

struct CellPoint {
  std::uint64_t cell = 0;
  std::uint32_t point = 0;
  friend bool operator<(const CellPoint& a, const CellPoint& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.point < b.point;
  }
};

/// Points that are not on the building, sorted by the cells they lie in.
std::vector<CellPoint> clear_points(const Cloud& cloud, const StructureSearch& structure,
                                    const Eigen::Vector3d& origin, double cell) {
  constexpr std::size_t block_size = 1 << 14;
  std::vector<std::vector<CellPoint>> found((cloud.points.size() + block_size - 1) / block_size);
  parallel_for(cloud.points.size(), block_size, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (cloud.normals[i].isZero()) continue;
      const Eigen::Vector3d p = cloud.points[i].cast<double>();
      if (!structure.is_clear(p)) continue;
      const auto at = ((p - origin) / cell).cast<std::uint64_t>().eval();
      found[begin / block_size].push_back(
          {at.z() << 42 | at.y() << 21 | at.x(), static_cast<std::uint32_t>(i)});
    }
  });
  std::vector<CellPoint> all;
  for (const auto& block : found) all.insert(all.end(), block.begin(), block.end());
  std::sort(all.begin(), all.end());
  return all;
}

/// Points of a cell, and where it is.
struct Cell {
  std::span<const CellPoint> points;
  Eigen::Vector3d middle;
  std::int32_t room = -1;
};

std::vector<Cell> cells_in_rooms(const Cloud& cloud, std::span<const CellPoint> points,
                                 const RoomMap& rooms, double clearance) {
  std::vector<Cell> cells;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (end = begin; end < points.size() && points[end].cell == points[begin].cell; ++end)
      sum += cloud.points[points[end].point].cast<double>();
    cells.push_back(
        {points.subspan(begin, end - begin), sum / static_cast<double>(end - begin), -1});
  }
  const RoomRings rings(rooms);
  parallel_for(cells.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      cells[i].room = rings.room_at(cells[i].middle, clearance);
  });
  std::erase_if(cells, [](const Cell& cell) { return cell.room < 0; });
  return cells;
}

/// Cells that hang together, each list ascending.
std::vector<std::vector<std::uint32_t>> clusters(const std::vector<Cell>& cells, double max_gap) {
  std::vector<Eigen::Vector3f> middles;
  for (const Cell& cell : cells) middles.push_back(cell.middle.cast<float>());
  const KdTree tree(middles);
  std::vector<std::vector<std::uint32_t>> lower(cells.size());  // neighbours of each
  parallel_for(cells.size(), 512, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      tree.within(middles[i], static_cast<float>(max_gap), near);
      for (const Neighbour& other : near)
        if (other.index < i && cells[other.index].room == cells[i].room)
          lower[i].push_back(other.index);
    }
  });
  std::vector<std::uint32_t> parent(cells.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < cells.size(); ++i)
    for (const std::uint32_t other : lower[i]) {
      const std::uint32_t a = root(i), b = root(other);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<std::vector<std::uint32_t>> of_root(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) of_root[root(i)].push_back(i);
  std::erase_if(of_root, [](const auto& cluster) { return cluster.empty(); });
  return of_root;
}

SceneObject object_of(const std::vector<std::uint32_t>& cluster, const std::vector<Cell>& cells,
                      const Cloud& cloud, const RoomMap& rooms, const ObjectParams& params) {
  SceneObject object;
  object.room = static_cast<std::size_t>(cells[cluster[0]].room);
  ObjectCells contents;
  for (const std::uint32_t i : cluster) {
    contents.first.push_back(contents.points.size());
    for (const CellPoint& point : cells[i].points) {
      object.points.push_back(point.point);
      contents.points.push_back(cloud.points[point.point].cast<double>());
    }
  }
  contents.first.push_back(contents.points.size());
  const Room& room = rooms.rooms[object.room];
  object.box = reaching_walls(box_round(contents, params.max_stray), room, 2 * params.clearance);
  const double floor = floor_of(room), top = object.box.base() + object.box.size.z();
  object.is_on_floor = object.box.base() < floor + params.floor_gap;
  if (object.is_on_floor) {
    object.box.size.z() = top - floor;
    object.box.centre.z() = (top + floor) / 2;
  }
  return object;
}

bool is_large_enough(const SceneObject& object, const ObjectParams& params) {
  return object.points.size() >= params.min_points && object.box.size.maxCoeff() >= params.min_size;
}

}  // namespace

std::vector<SceneObject> find_objects(const Cloud& cloud, const PolygonMap& map,
                                      const Labels& labels, const RoomMap& rooms,
                                      const ObjectParams& params) {
  check(cloud, map, labels, params);
  const Eigen::AlignedBox3d bounds = bounds_of(rooms);
  if (bounds.isEmpty()) return {};
  const StructureSearch structure(map, labels, bounds, params.clearance);
  const std::vector<CellPoint> points = clear_points(cloud, structure, bounds.min(), params.cell);
  const std::vector<Cell> cells = cells_in_rooms(cloud, points, rooms, params.clearance);
  std::vector<SceneObject> objects;
  for (const auto& cluster : clusters(cells, params.max_gap)) {
    if (cluster.size() < params.min_cells) continue;
    SceneObject object = object_of(cluster, cells, cloud, rooms, params);
    if (!is_large_enough(object, params)) continue;
    object.polygons = polygons_in(object.box, map, labels, params.clearance);
    objects.push_back(std::move(object));
  }
  std::stable_sort(objects.begin(), objects.end(), [](const auto& a, const auto& b) {
    return a.room != b.room ? a.room < b.room : a.points.size() > b.points.size();
  });
  return objects;
}

}  // namespace planum
