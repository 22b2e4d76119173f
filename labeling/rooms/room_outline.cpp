#include "labeling/rooms/room_outline.hpp"

#include <algorithm>
#include <cmath>

#include "labeling/plan/grid_border.hpp"
#include "labeling/plan/grid_morphology.hpp"
#include "labeling/plan/plan_ring.hpp"
#include "labeling/rooms/border_runs.hpp"

namespace planum {
namespace {

/// Decides which stretches without a face are only unseen parts of a room.
class Completion {
 public:
  Completion(const FloorGrid& grid, const RoomRegions& regions, std::int32_t region,
             const CellMask& wall, const BorderRuns& border, double region_area,
             const RoomOutlineParams& params)
      : grid_(grid),
        regions_(regions),
        region_(region),
        wall_(wall),
        border_(border),
        region_area_(region_area),
        params_(params) {}

  bool may_go(const BorderRun& before, const BorderRun& run, const BorderRun& after) const {
    if (run.face) return run.length <= 1.5 * grid_.cell;
    if (run.length <= params_.short_gap) return true;
    Eigen::Vector2d meeting;
    return faces_meet(*before.face, *after.face, meeting)
               ? completes_corner(before, run, after, meeting)
               : bridges_gap(*before.face, run, *after.face);
  }

 private:
  std::vector<Eigen::Vector2d> corners_of(const BorderRun& run) const {
    std::vector<Eigen::Vector2d> ring;
    for (std::size_t i = run.first; i <= run.last; ++i) ring.push_back(border_.corner(i));
    return ring;
  }

  /// The wall goes on to the corner, and then along the next wall: no way back.
  bool completes_corner(const BorderRun& before, const BorderRun& run, const BorderRun& after,
                        const Eigen::Vector2d& meeting) const {
    const auto onwards = [](const WallFace& face) { return Eigen::Vector2d(-face.tangent()); };
    const double slack = 3 * grid_.cell;
    if ((meeting - border_.corner(run.first)).dot(onwards(*before.face)) < -slack ||
        (border_.corner(run.last) - meeting).dot(onwards(*after.face)) < -slack)
      return false;
    std::vector<Eigen::Vector2d> ring = corners_of(run);
    ring.push_back(meeting);
    return std::abs(ring_area(ring)) < params_.max_completion * region_area_ &&
           unseen(ring, *before.face, *after.face);
  }

  /// Both stretches lie on one plane, and between them is a doorway or something unseen.
  bool bridges_gap(const WallFace& before, const BorderRun& run, const WallFace& after) const {
    const Eigen::Vector2d from = border_.corner(run.first), to = border_.corner(run.last);
    if (std::abs(before.signed_distance(to) - after.signed_distance(to)) > 0.08) return false;
    std::vector<Eigen::Vector2d> ring = corners_of(run);
    for (const Eigen::Vector2d& p : ring)
      if (before.signed_distance(p) < -params_.max_recess) return false;
    ring.push_back(to - after.signed_distance(to) * after.normal);
    ring.push_back(from - before.signed_distance(from) * before.normal);
    return unseen(ring, before, after);
  }

  /// No other region and no other wall inside the ring?
  bool unseen(const std::vector<Eigen::Vector2d>& ring, const WallFace& a,
              const WallFace& b) const {
    const double near = 3 * grid_.cell;
    std::size_t cells = 0, other_region = 0, other_wall = 0;
    for_each_cell_inside(grid_, ring, [&](std::size_t cell) {
      ++cells;
      const Eigen::Vector2d p = grid_.centre(cell);
      const bool beside =
          std::abs(a.signed_distance(p)) < near || std::abs(b.signed_distance(p)) < near;
      const std::int32_t region = regions_.of_cell[cell];
      if (region >= 0 && region != region_ && !beside) ++other_region;
      if (wall_[cell] && !beside) ++other_wall;
    });
    return 50 * other_region <= cells && other_wall <= 5;
  }

  const FloorGrid& grid_;
  const RoomRegions& regions_;
  std::int32_t region_;
  const CellMask& wall_;
  const BorderRuns& border_;
  double region_area_;
  const RoomOutlineParams& params_;
};

/// What the region encloses without being part of it and is bounded by faces: pillars, cores. What
/// was only not seen is no hole.
std::vector<std::vector<Eigen::Vector2d>> holes_of(const FloorGrid& grid,
                                                   const RoomRegions& regions, std::int32_t region,
                                                   const std::vector<RegionFace>& own_faces,
                                                   const std::vector<WallFace>& faces,
                                                   double short_gap) {
  constexpr double min_face_share = 0.5, min_area = 0.02;
  CellMask outside(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) outside[i] = regions.of_cell[i] != region;
  const CellComponents parts = connected_components(outside, grid.columns, grid.rows);
  std::vector<std::uint8_t> enclosed(parts.sizes.size(), 1);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const int column = grid.column(i), row = grid.row(i);
    const bool at_edge =
        column == 0 || row == 0 || column + 1 == grid.columns || row + 1 == grid.rows;
    if (at_edge && parts.of_cell[i] >= 0) enclosed[static_cast<std::size_t>(parts.of_cell[i])] = 0;
  }
  std::vector<std::vector<Eigen::Vector2d>> holes;
  for (std::size_t p = 0; p < enclosed.size(); ++p) {
    if (!enclosed[p] || static_cast<double>(parts.sizes[p]) * grid.cell * grid.cell < min_area)
      continue;
    BorderRuns border(grid, own_faces, faces,
                      border_corners(grid, parts.of_cell, static_cast<std::int32_t>(p)),
                      BorderSide::around_pillar);
    if (border.face_share() < min_face_share) continue;
    border.drop([&](const BorderRun&, const BorderRun& run, const BorderRun&) {
      return run.length <= (run.face ? 1.5 * grid.cell : short_gap);
    });
    std::vector<Eigen::Vector2d> ring = border.ring();
    if (ring_area(ring) > 0) holes.push_back(std::move(ring));
  }
  return holes;
}

}  // namespace

RoomOutline region_outline(const FloorGrid& grid, const RoomRegions& regions, std::size_t region,
                           const std::vector<RegionFace>& own_faces,
                           const std::vector<WallFace>& faces, const CellMask& wall,
                           const RoomOutlineParams& params) {
  RoomOutline outline;
  const auto label = static_cast<std::int32_t>(region);
  std::vector<Eigen::Vector2i> corners = border_corners(grid, regions.of_cell, label);
  if (corners.empty()) return outline;
  std::vector<Eigen::Vector2d> cells;
  for (const Eigen::Vector2i& c : corners) cells.push_back(c.cast<double>() * grid.cell);
  const double cell_area = ring_area(cells);
  BorderRuns border(grid, own_faces, faces, std::move(corners), BorderSide::around_room);
  const Completion completion(grid, regions, label, wall, border, cell_area, params);
  border.drop([&](const BorderRun& before, const BorderRun& run, const BorderRun& after) {
    return completion.may_go(before, run, after);
  });
  constexpr double max_slit = 0.12;  // m; no niche is that narrow
  outline.outer = without_slits(border.ring(), max_slit);
  outline.area = ring_area(outline.outer);
  // A ring that went wrong is no measure; the cells always are.
  if (outline.area < 0.8 * cell_area || outline.area > 2.2 * cell_area) {
    outline.outer = cells;
    outline.area = cell_area;
  }
  outline.holes = holes_of(grid, regions, label, own_faces, faces, params.short_gap);
  for (const std::vector<Eigen::Vector2d>& hole : outline.holes) outline.area -= ring_area(hole);
  return outline;
}

}  // namespace planum
