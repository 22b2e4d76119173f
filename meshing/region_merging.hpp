#pragma once

#include "meshing/half_edge.hpp"
#include "meshing/regions.hpp"

namespace planum {

/// Joins regions that touch and are one plane (see RegionParams::merge_angle, merge_distance), the
/// best fitting pairs first; drops regions below min_area; sorts by area, the largest first.
Regions merged(const Regions& regions, const TriangleMesh& mesh, const HalfEdges& edges,
               const RegionParams& params);

}  // namespace planum
