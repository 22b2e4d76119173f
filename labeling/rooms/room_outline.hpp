#pragma once

#include <vector>

#include <Eigen/Core>

#include "labeling/rooms/region_faces.hpp"
#include "labeling/rooms/room_regions.hpp"

namespace planum {

struct RoomOutlineParams {
  double short_gap = 0.30;       ///< m, interruptions of a face that are closed in any case
  double max_recess = 0.70;      ///< m, doorways and niches up to this depth are cut off
  double max_completion = 0.50;  ///< of a region's area: unseen corners larger than this stay out
};

/// The border of a region in the plan frame.
struct RoomOutline {
  std::vector<Eigen::Vector2d> outer;               ///< m, counter-clockwise
  std::vector<std::vector<Eigen::Vector2d>> holes;  ///< pillars, cores; counter-clockwise as well
  double area = 0;                                  ///< m^2, without the holes
};

/// The border of a region follows the wall faces where there are any, else the cells. Corners that
/// no scan saw are completed where both walls beside them point there and nothing else is known to
/// be in between. `own_faces` are those of the region, `wall` the cells on any face.
RoomOutline region_outline(const FloorGrid& grid, const RoomRegions& regions, std::size_t region,
                           const std::vector<RegionFace>& own_faces,
                           const std::vector<WallFace>& faces, const CellMask& wall,
                           const RoomOutlineParams& params = {});

}  // namespace planum
