#include "labeling/rooms/room_regions.hpp"

#include <algorithm>
#include <numeric>

#include "labeling/plan/grid_morphology.hpp"

namespace planum {
namespace {

/// Size and largest inscribed radius (cells) of each component.
struct Extent {
  double cells = 0;
  float half_width = 0;
};

std::vector<Extent> extents(const std::vector<std::int32_t>& of_cell,
                            const std::vector<float>& inside, std::size_t count) {
  std::vector<Extent> result(count);
  for (std::size_t i = 0; i < of_cell.size(); ++i) {
    if (of_cell[i] < 0) continue;
    Extent& e = result[static_cast<std::size_t>(of_cell[i])];
    e.cells += 1;
    e.half_width = std::max(e.half_width, inside[i]);
  }
  return result;
}

}  // namespace

RoomRegions split_into_regions(const FloorGrid& grid, const CellMask& seen, const CellMask& wall,
                               const RoomRegionParams& params) {
  CellMask open = closed(seen, grid.columns, grid.rows, params.fill_radius / grid.cell);
  for (std::size_t i = 0; i < open.size(); ++i)
    if (wall[i]) open[i] = 0;
  const std::vector<float> inside = distance_to_unset(open, grid.columns, grid.rows);
  CellMask core(open.size(), 0);
  for (std::size_t i = 0; i < open.size(); ++i)
    core[i] = double{inside[i]} * grid.cell > 0.5 * params.min_neck;
  CellComponents parts = connected_components(core, grid.columns, grid.rows);
  spread_labels(parts.of_cell, open, grid.columns, grid.rows,
                static_cast<int>(params.min_neck / grid.cell));
  const std::vector<Extent> extent = extents(parts.of_cell, inside, parts.sizes.size());
  std::vector<std::size_t> kept;
  for (std::size_t r = 0; r < extent.size(); ++r)
    if (extent[r].cells * grid.cell * grid.cell >= params.min_area &&
        double{extent[r].half_width} * grid.cell >= params.min_half_width)
      kept.push_back(r);
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return extent[a].cells > extent[b].cells; });
  std::vector<std::int32_t> new_id(extent.size(), -1);
  for (std::size_t k = 0; k < kept.size(); ++k) new_id[kept[k]] = static_cast<std::int32_t>(k);
  RoomRegions regions;
  regions.count = kept.size();
  regions.of_cell = std::move(parts.of_cell);
  for (std::int32_t& r : regions.of_cell)
    if (r >= 0) r = new_id[static_cast<std::size_t>(r)];
  return regions;
}

}  // namespace planum
