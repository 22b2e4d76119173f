#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/room_regions.hpp"
#include "labeling/wall_faces.hpp"

namespace planum {

/// The part of a wall face that bounds a region.
struct RegionFace {
  std::size_t region = 0;
  std::size_t face = 0;
  double begin = 0, end = 0;  ///< m along the face's tangent
  double length() const { return end - begin; }
};

/// Which parts of which faces look into which regions, by region, then by face.
std::vector<RegionFace> faces_of_regions(const FloorGrid& grid, const RoomRegions& regions,
                                         const std::vector<WallFace>& faces);

/// The border of a region as a ring, counter-clockwise, in the plan frame. It follows the wall
/// faces where there are any, else the cells. `own_faces` are those of the region.
std::vector<Eigen::Vector2d> region_outline(const FloorGrid& grid, const RoomRegions& regions,
                                            std::size_t region,
                                            const std::vector<RegionFace>& own_faces,
                                            const std::vector<WallFace>& faces);

/// Signed area of a ring, positive if counter-clockwise.
double ring_area(const std::vector<Eigen::Vector2d>& ring);

/// Whether a point lies inside a ring.
bool ring_contains(const std::vector<Eigen::Vector2d>& ring, const Eigen::Vector2d& p);

}  // namespace planum
