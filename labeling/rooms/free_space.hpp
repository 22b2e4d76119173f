#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "labeling/plan/floor_grid.hpp"
#include "labeling/rooms/wall_faces.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// A place on the plane of a wall face.
struct FaceSample {
  std::uint32_t face = 0;  ///< index of the wall face
  float along = 0;         ///< m, along the face's tangent
  float height = 0;        ///< m, z in the plan frame
};

/// Where rays met wall faces; sorted by face, then in order of the points.
struct FaceSamples {
  std::vector<FaceSample> crossings;  ///< rays that went through a face: doors and windows
  std::vector<FaceSample> hits;       ///< rays that ended on a face
};

struct RayParams {
  double overshoot = 0.12;     ///< m, a ray that ends this far behind a face went through it
  double hit_distance = 0.04;  ///< m, a ray that ends this near a face hit it
  double end_reach = 0.20;     ///< m beyond the ends of a face where samples are still its own
  double end_margin = 0.08;    ///< m, the last part of a ray that is not called free
  std::size_t max_free_rays = 400000;  ///< rays that mark free cells; samples use all
};

/// Cells that rays from the scanners to the points passed, at any height. `plan` is the merged
/// cloud with its `scan` index, `origins` the scanners' positions, both in the plan frame.
CellMask free_cells(const Cloud& plan, std::span<const Eigen::Vector3d> origins,
                    const FloorGrid& grid, const RayParams& params = {});

/// Cells on a wall face: they part rooms.
CellMask wall_cells(const FloorGrid& grid, const std::vector<WallFace>& faces);

/// Where the rays of all points meet the faces.
FaceSamples sample_faces(const Cloud& plan, std::span<const Eigen::Vector3d> origins,
                         const FloorGrid& grid, const std::vector<WallFace>& faces,
                         const RayParams& params = {});

/// The samples of one face; `samples` are sorted by face.
std::span<const FaceSample> samples_of_face(const std::vector<FaceSample>& samples,
                                            std::size_t face);

}  // namespace planum
