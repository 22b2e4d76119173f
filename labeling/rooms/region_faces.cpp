#include "labeling/rooms/region_faces.hpp"

#include <algorithm>

namespace planum {
namespace {

/// The region in front of a place on a face, or -1.
std::int32_t region_before(const FloorGrid& grid, const RoomRegions& regions, const WallFace& face,
                           double along) {
  for (const double distance : {0.08, 0.13, 0.18, 0.25}) {
    const std::ptrdiff_t cell = grid.find(face.at(along) + distance * face.normal);
    if (cell < 0) return -1;
    const std::int32_t region = regions.of_cell[static_cast<std::size_t>(cell)];
    if (region >= 0) return region;
  }
  return -1;
}

}  // namespace

std::vector<RegionFace> faces_of_regions(const FloorGrid& grid, const RoomRegions& regions,
                                         const std::vector<WallFace>& faces) {
  std::vector<RegionFace> result;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double step = 0.5 * grid.cell;
    std::int32_t current = -1;
    for (double along = faces[f].begin; along <= faces[f].end; along += step) {
      const std::int32_t region = region_before(grid, regions, faces[f], along);
      if (region >= 0 && region == current) {
        result.back().end = along;
      } else if (region >= 0) {
        result.push_back({static_cast<std::size_t>(region), f, along, along});
        current = region;
      }
    }
  }
  std::erase_if(result, [](const RegionFace& f) { return f.length() < 0.1; });
  std::stable_sort(result.begin(), result.end(),
                   [](const RegionFace& a, const RegionFace& b) { return a.region < b.region; });
  return result;
}

}  // namespace planum
