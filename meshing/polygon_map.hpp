#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/plane.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Indices of vertices in order; the last is joined to the first.
using Ring = std::vector<std::uint32_t>;

/// A plane polygon with holes.
struct MapPolygon {
  Plane plane;              ///< normal into free space
  Ring outer;               ///< counter-clockwise seen from free space
  std::vector<Ring> holes;  ///< clockwise seen from free space
  double area = 0;          ///< m^2, of the outer ring minus the holes
};

/// A part of a polygon's plane that nobody saw because something stood before it.
struct InferredPatch {
  std::uint32_t polygon = 0;  ///< whose plane it continues
  MapPolygon shape;           ///< plane, rings and area; it fills a hole or a notch of the polygon
};

/// Plane polygons that share vertices with their neighbours, and what is not plane as triangles.
struct PolygonMap {
  std::vector<Eigen::Vector3d> vertices;  ///< m
  std::vector<MapPolygon> polygons;
  TriangleMesh rest;                    ///< curved parts and parts too small to be polygons
  std::vector<InferredPatch> inferred;  ///< laser shadows, no part of the polygons; may be empty
};

}  // namespace planum
