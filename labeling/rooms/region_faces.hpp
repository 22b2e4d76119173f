#pragma once

#include <vector>

#include "labeling/rooms/room_regions.hpp"
#include "labeling/rooms/wall_faces.hpp"

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

}  // namespace planum
