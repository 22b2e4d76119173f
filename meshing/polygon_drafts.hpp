#pragma once

#include <cstdint>
#include <vector>

#include "meshing/borders.hpp"
#include "meshing/chain_shapes.hpp"
#include "meshing/corner_snapping.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygon_map.hpp"
#include "meshing/regions.hpp"

namespace planum {

/// The borders of all regions of a mesh: lines, how they hang together, and their points.
struct BorderNetwork {
  std::vector<Region> regions;
  std::vector<std::uint32_t> labels;        ///< of triangles
  std::vector<std::uint32_t> component_of;  ///< for each triangle its connected part of a region
  std::vector<BorderChain> chains;
  std::vector<BorderRing> rings;
  SnappedCorners corners;
  std::vector<ChainShape> shapes;  ///< of the chains
};

/// A polygon while its vertices are still snapped points.
struct PolygonDraft {
  std::uint32_t region = 0;
  std::vector<Ring> rings;            ///< the outer one first
  std::vector<std::uint32_t> chains;  ///< what its rings are made of
  bool is_scrap = false;              ///< too small to be a polygon
};

struct DraftParams {
  double min_hole = 0.02;  ///< m^2, smaller holes that only the rim of the mesh bounds are closed
  double min_area = 0.02;  ///< m^2, of a polygon
};

/// Rings of points in a plane, flat.
std::vector<Ring2d> flat_rings(const std::vector<Ring>& rings, const Plane& plane,
                               const std::vector<Eigen::Vector3d>& points);

/// The polygons that the borders, as they are simplified now, bound: each connected part of a
/// region with its holes.
std::vector<PolygonDraft> polygon_drafts(const BorderNetwork& network, const DraftParams& params);

}  // namespace planum
