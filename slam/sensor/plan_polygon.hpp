#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// A polygon in plan; its rings close by themselves and may turn either way.
struct PlanPolygon {
  std::vector<Eigen::Vector2d> outer = {};               ///< m
  std::vector<std::vector<Eigen::Vector2d>> holes = {};  ///< m
};

/// The same polygon, outer ring counter-clockwise and holes clockwise: the inside lies to the left.
/// Throws Error if a ring has fewer than three corners or no area.
PlanPolygon oriented(const PlanPolygon& polygon);

/// m^2, without the holes.
double area(const PlanPolygon& polygon);

/// Counter-clockwise triangles that fill a polygon and use all of its corners and no others
/// (constrained Delaunay triangulation by GEOS). Throws Error if rings cross.
std::vector<std::array<Eigen::Vector2d, 3>> triangulated(const PlanPolygon& polygon);

/// The smallest rectangle round a polygon.
struct PlanRectangle {
  Eigen::Vector2d centre;
  double width = 0;  ///< m, the shorter side
  double depth = 0;  ///< m
};

/// The rectangle of least area round a polygon's outer ring; one of its sides lies along an edge.
PlanRectangle smallest_rectangle(const PlanPolygon& polygon);

}  // namespace planum
