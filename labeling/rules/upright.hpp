#pragma once

#include <cstddef>
#include <vector>

#include "labeling/label_scene.hpp"

namespace planum {

/// A stretch along a direction (m).
struct Extent {
  double from, to;
  double length() const { return to - from; }
  double middle() const { return (from + to) / 2; }
};

/// Unit, horizontal, along an upright polygon: its normal turned left.
Eigen::Vector2d along(const LevelPolygon& upright);

/// From where to where a polygon reaches along a direction.
Extent extent(const LevelPolygon& polygon, const Eigen::Vector2d& direction);

/// Of an upright polygon, along itself.
double width(const LevelPolygon& upright);

/// Share of the width of `upright` that `other` covers too, seen along its normal.
double overlap(const LevelPolygon& upright, const LevelPolygon& other);

/// How far the middle of `other` is in front of the plane of `upright`.
double in_front_of(const LevelPolygon& upright, const LevelPolygon& other);

/// Whether both are upright and look the same way, within some degrees.
bool faces_like(const LevelPolygon& upright, const LevelPolygon& other);

/// Whether a place on the plane of an upright polygon, at `u` along it and at a height, is inside.
bool covers_upright(const LevelPolygon& upright, double u, double height);

/// How many vertices two polygons share.
std::size_t shared_vertices(const LevelPolygon& a, const LevelPolygon& b);

}  // namespace planum
