#pragma once

#include <span>

#include <Eigen/Core>

#include "meshing/polygon_map.hpp"
#include "meshing/range_map.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// Which holes in planes are laser shadows.
struct ShadowParams {
  double max_area = 4;           ///< m^2, larger ones are not filled; 0: none is
  double min_area = 0.02;        ///< m^2, smaller ones neither
  double sample = 0.05;          ///< m, places in a hole are judged this far apart, or farther in
                                 ///< large ones
  double min_hidden = 0.5;       ///< share of places that rays only ended before
  double min_known = 0.8;        ///< share of places that rays ended before, or at
  double max_open = 0.1;         ///< share of places that a ray went through, or from which
                                 ///< none came back to a scan that sees the border
  double min_free_border = 0.5;  ///< share of the border that no other polygon shares: what other
                                 ///< polygons close off is the foot of a thing
  SightParams sight = {};
};

/// Finds the laser shadows in a map's polygons and puts them into `inferred` (Wiemann, Nuechter,
/// Lingemann, Hertzberg 2010 name it as future work): holes in a polygon, and notches in its border
/// that begin and end at the same neighbour (the wall that a floor ends at), or at two neighbours
/// that meet in a corner there. Filled are those which rays do not pass, but end before.
///
/// The polygons stay as they are; corners of rooms that nobody saw become new vertices.
/// `cloud.scan` says which of `scan_origins` saw a point; it may be empty if there is one origin.
/// Throws Error if a point has no origin, and for parameters out of range.
PolygonMap with_shadows_filled(PolygonMap map, const Cloud& cloud,
                               std::span<const Eigen::Vector3d> scan_origins,
                               const ShadowParams& params = {});

}  // namespace planum
