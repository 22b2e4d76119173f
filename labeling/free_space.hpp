#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "labeling/floor_grid.hpp"
#include "labeling/level_surfaces.hpp"
#include "labeling/wall_faces.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// A place on the plane of a wall face.
struct FaceSample {
  std::uint32_t face = 0;  ///< index of the wall face
  float along = 0;         ///< m, along the face's tangent
  float height = 0;        ///< m, z in the plan frame
};

/// What the rays say about the floor plan. Samples are sorted by face, then in order of the points.
struct FreeSpace {
  CellMask free;                      ///< cells that a ray passed, at any height
  CellMask wall;                      ///< cells on a wall face: they part rooms
  std::vector<FaceSample> crossings;  ///< where rays went through a face: doors and windows
  std::vector<FaceSample> hits;       ///< where rays ended on a face
};

struct FreeSpaceParams {
  double overshoot = 0.12;     ///< m, a ray that ends this far behind a face went through it
  double hit_distance = 0.04;  ///< m, a ray that ends this near a face hit it
  double end_reach = 0.20;     ///< m, hits beyond the ends of a face are its as well: other walls
  double end_margin = 0.08;    ///< m, the last part of a ray that is not called free
  std::size_t max_free_rays = 400000;  ///< rays that mark free cells; samples use all
};

/// Follows the rays from the scanners to the points over the grid. `plan` is the merged cloud with
/// its `scan` index, `origins` the scanners' positions, both in the plan frame.
FreeSpace trace_rays(const Cloud& plan, std::span<const Eigen::Vector3d> origins,
                     const FloorGrid& grid, const std::vector<WallFace>& faces,
                     const FreeSpaceParams& params = {});

}  // namespace planum
