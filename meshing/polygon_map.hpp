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

/// Plane polygons that share vertices with their neighbours, and what is not plane as triangles.
struct PolygonMap {
  std::vector<Eigen::Vector3d> vertices;  ///< m
  std::vector<MapPolygon> polygons;
  TriangleMesh rest;  ///< curved parts and parts too small to be polygons
};

}  // namespace planum
