#include "labeling/objects/object_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "labeling/objects/structure_search.hpp"
#include "meshing/plane_geometry.hpp"

namespace planum {
namespace {

constexpr double max_angle_to_wall = radians(10);

/// From where to where cells reach along a direction, without those that stray.
std::pair<double, double> extent(const ObjectCells& cells, const Eigen::Vector3d& direction,
                                 double max_stray) {
  const std::size_t count = cells.first.size() - 1;
  std::vector<double> lows(count), highs(count);
  for (std::size_t i = 0; i < count; ++i) {
    lows[i] = highs[i] = direction.dot(cells.points[cells.first[i]]);
    for (std::size_t k = cells.first[i]; k < cells.first[i + 1]; ++k) {
      lows[i] = std::min(lows[i], direction.dot(cells.points[k]));
      highs[i] = std::max(highs[i], direction.dot(cells.points[k]));
    }
  }
  const auto strays = static_cast<std::ptrdiff_t>(max_stray * static_cast<double>(count));
  std::nth_element(lows.begin(), lows.begin() + strays, lows.end());
  std::nth_element(highs.begin(), highs.begin() + strays, highs.end(), std::greater<>());
  return {lows[static_cast<std::size_t>(strays)], highs[static_cast<std::size_t>(strays)]};
}

/// The box between two corners in a frame turned about z.
OrientedBox box_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                        const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  const Eigen::Vector3d middle = (low + high) / 2;
  OrientedBox box{middle.x() * x + middle.y() * y + middle.z() * Eigen::Vector3d::UnitZ(), x,
                  high - low};
  if (box.size.x() >= box.size.y()) return box;
  box.along = y;
  std::swap(box.size.x(), box.size.y());
  return box;
}

/// How far a wall of the room is in front of a side, if there is a parallel one within reach.
double distance_to_wall(const Eigen::Vector2d& side, const Eigen::Vector2d& outward,
                        const Room& room, double reach) {
  double nearest = reach;
  bool found = false;
  for (std::size_t i = 0; i < room.outline.size(); ++i) {
    const Eigen::Vector2d a = room.outline[i].head<2>();
    const Eigen::Vector2d edge = room.outline[(i + 1) % room.outline.size()].head<2>() - a;
    const double length = edge.norm();
    if (std::abs(edge.dot(outward)) > std::sin(max_angle_to_wall) * length) continue;
    const double along = (side - a).dot(edge) / length, ahead = (a - side).dot(outward);
    if (along < 0 || along > length || ahead < 0 || ahead >= nearest) continue;
    nearest = ahead;
    found = true;
  }
  return found ? nearest : 0;
}

}  // namespace

OrientedBox box_round(const ObjectCells& cells, double max_stray) {
  std::vector<Eigen::Vector2d> middles;
  for (std::size_t i = 0; i + 1 < cells.first.size(); ++i) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t k = cells.first[i]; k < cells.first[i + 1]; ++k)
      sum += cells.points[k].head<2>();
    middles.push_back(sum / static_cast<double>(cells.first[i + 1] - cells.first[i]));
  }
  const double direction = direction_of_rectangle(middles, max_stray);
  const Eigen::Vector3d x(std::cos(direction), std::sin(direction), 0), y(-x.y(), x.x(), 0);
  const auto [x0, x1] = extent(cells, x, max_stray);
  const auto [y0, y1] = extent(cells, y, max_stray);
  const auto [z0, z1] = extent(cells, Eigen::Vector3d::UnitZ(), max_stray);
  return box_between({x0, y0, z0}, {x1, y1, z1}, x, y);
}

OrientedBox reaching_walls(const OrientedBox& box, const Room& room, double reach) {
  const Eigen::Vector3d x = box.along, y = Eigen::Vector3d::UnitZ().cross(x);
  Eigen::Vector3d low(x.dot(box.centre), y.dot(box.centre), box.centre.z());
  Eigen::Vector3d high = low + box.size / 2;
  low -= box.size / 2;
  const std::array axes = {x, y};
  for (int axis = 0; axis < 2; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d outward = sign * axes[static_cast<std::size_t>(axis)];
      const Eigen::Vector3d side = box.centre + box.size[axis] / 2 * outward;
      const double gap = distance_to_wall(side.head<2>(), outward.head<2>(), room, reach);
      (sign < 0 ? low : high)[axis] += sign * gap;
    }
  return box_between(low, high, x, y);
}

std::vector<std::uint32_t> polygons_in(const OrientedBox& box, const PolygonMap& map,
                                       const Labels& labels, double margin) {
  const Pose box_from_world = box.world_from_box().inverse();
  const Eigen::Array3d reach = (box.size / 2).array() + margin;
  const auto is_inside_box = [&](std::uint32_t vertex) {
    Eigen::Vector3d p = box_from_world * map.vertices[vertex];
    p.z() -= box.size.z() / 2;
    return (p.array().abs() <= reach).all();
  };
  std::vector<std::uint32_t> inside;
  for (std::uint32_t i = 0; i < map.polygons.size(); ++i)
    if (!is_structure(labels.polygons[i].label) &&
        std::all_of(map.polygons[i].outer.begin(), map.polygons[i].outer.end(), is_inside_box))
      inside.push_back(i);
  return inside;
}

}  // namespace planum
