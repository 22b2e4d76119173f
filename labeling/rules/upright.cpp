#include "labeling/rules/upright.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "labeling/plan/plan_ring.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

const double same_direction = std::cos(radians(8));

}  // namespace

Eigen::Vector2d along(const LevelPolygon& upright) {
  return Eigen::Vector2d(-upright.plane.normal.y(), upright.plane.normal.x()).normalized();
}

Extent extent(const LevelPolygon& polygon, const Eigen::Vector2d& direction) {
  Extent range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Eigen::Vector2d& p : polygon.plan.front()) {
    range.from = std::min(range.from, direction.dot(p));
    range.to = std::max(range.to, direction.dot(p));
  }
  return range;
}

double width(const LevelPolygon& upright) { return extent(upright, along(upright)).length(); }

double overlap(const LevelPolygon& upright, const LevelPolygon& other) {
  const Eigen::Vector2d run = along(upright);
  const Extent own = extent(upright, run), its = extent(other, run);
  return (std::min(own.to, its.to) - std::max(own.from, its.from)) / std::max(own.length(), 1e-9);
}

double in_front_of(const LevelPolygon& upright, const LevelPolygon& other) {
  return upright.plane.signed_distance((other.low + other.high) / 2);
}

bool faces_like(const LevelPolygon& upright, const LevelPolygon& other) {
  return other.attitude == Attitude::upright &&
         upright.plane.normal.dot(other.plane.normal) > same_direction;
}

bool covers_upright(const LevelPolygon& upright, double u, double height) {
  const Eigen::Vector2d run = along(upright);
  std::vector<Ring2d> flat;
  for (const auto& ring : upright.rings) {
    flat.emplace_back();
    for (const Eigen::Vector3d& p : ring) flat.back().emplace_back(run.dot(p.head<2>()), p.z());
  }
  return rings_contain(flat, {u, height});
}

std::size_t shared_vertices(const LevelPolygon& a, const LevelPolygon& b) {
  return static_cast<std::size_t>(
      std::count_if(a.outer.begin(), a.outer.end(), [&](std::uint32_t v) {
        return std::find(b.outer.begin(), b.outer.end(), v) != b.outer.end();
      }));
}

}  // namespace planum
