#include "tools/maps/texture_frames.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "tools/maps/label_textures.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;

const double min_level = std::cos(radians(15));  // of the normal's z: steeper ones have a direction

/// The direction, up to quarter turns, along which most of the upright surface lies: the mean of
/// the directions times four, weighted by area. Level, unit.
Vector3d main_direction(const PolygonMap& map) {
  double along = 0, across = 0;
  for (const MapPolygon& polygon : map.polygons) {
    const Vector3d& n = polygon.plane.normal;
    const double turn = 4 * std::atan2(n.y(), n.x()), weight = polygon.area * n.head<2>().norm();
    along += weight * std::cos(turn);
    across += weight * std::sin(turn);
  }
  const double turn = std::atan2(across, along) / 4;
  return {std::cos(turn), std::sin(turn), 0};
}

}  // namespace

std::vector<TextureFrame> texture_frames(const PolygonMap& map, const Labels& labels) {
  if (labels.polygons.size() != map.polygons.size())
    throw Error(fmt::format("textures: {} polygons with {} labels", map.polygons.size(),
                            labels.polygons.size()));
  const Vector3d along = main_direction(map);
  std::vector<TextureFrame> frames;
  for (std::size_t i = 0; i < map.polygons.size(); ++i) {
    const Vector3d& n = map.polygons[i].plane.normal;
    const bool is_level = std::abs(n.z()) > min_level;
    const Vector3d u = is_level ? along : Vector3d::UnitZ().cross(n).normalized();
    const Vector3d v = is_level ? Vector3d::UnitZ().cross(along) : n.cross(u);
    const double size = texture_size(labels.polygons[i].label);
    frames.push_back({u / size, v / size});
  }
  return frames;
}

}  // namespace planum
