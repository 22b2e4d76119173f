#include "labeling/rooms/openings.hpp"

#include <algorithm>
#include <optional>

#include "labeling/rooms/hole_evidence.hpp"
#include "labeling/rooms/wall_hole.hpp"

namespace planum {
namespace {

/// The regions on both sides: the first that lies before or behind the hole.
void find_regions(WallHole& hole, const FloorGrid& grid, const RoomRegions& regions) {
  constexpr double reach = 0.8;  // m
  for (const int side : {0, 1}) {
    const double start = side == 0 ? 0.0 : hole.thickness;
    const Eigen::Vector2d direction = side == 0 ? Eigen::Vector2d(-hole.inwards) : hole.inwards;
    const Eigen::Vector2d from = hole.centre + start * hole.inwards;
    for (double d = 0.05; d < reach && hole.regions[static_cast<std::size_t>(side)] < 0; d += 0.05)
      for (const double part : {0.0, -0.25, 0.25}) {
        const Eigen::Vector2d p =
            from + d * direction + part * hole.rectangle.width() * hole.tangent;
        const std::ptrdiff_t cell = grid.find(p);
        if (cell < 0) continue;
        const std::int32_t region = regions.of_cell[static_cast<std::size_t>(cell)];
        if (region < 0) continue;
        hole.regions[static_cast<std::size_t>(side)] = region;
        break;
      }
  }
}

/// The length of the wall around an opening within one room.
double length_around(const FaceOpening& opening, const std::vector<WallFace>& faces,
                     const std::vector<RegionFace>& region_faces) {
  const double middle = 0.5 * (opening.begin + opening.end);
  for (const RegionFace& f : region_faces)
    if (f.face == opening.face && f.begin <= middle && middle <= f.end) return f.length();
  return faces[opening.face].length();
}

/// Hangs there only a beam between two parts of one room?
bool joins_regions(const WallHole& hole, const std::vector<WallFace>& faces,
                   const std::vector<RegionFace>& region_faces, const OpeningParams& params) {
  if (hole.regions[0] < 0 || hole.regions[1] < 0 || hole.regions[0] == hole.regions[1])
    return false;
  double length = length_around(hole.front, faces, region_faces);
  double ceiling = hole.front.ceiling;
  if (hole.back) {
    length = std::min(length, length_around(*hole.back, faces, region_faces));
    ceiling = std::min(ceiling, hole.back->ceiling);
  }
  const bool to_the_floor = hole.rectangle.bottom - hole.front.floor < params.max_unseen_sill;
  const bool wide = hole.rectangle.width() >= params.full_width * length;
  return to_the_floor && wide &&
         (hole.rectangle.width() > params.max_door_width ||
          hole.rectangle.top > ceiling - params.min_beam_drop);
}

/// What the hole is, or nothing if it is too small for what it would be.
std::optional<OpeningKind> kind_of(const WallHole& hole, const OpeningParams& params) {
  if (!hole.frame.complete()) return std::nullopt;
  if (hole.has_sill) return OpeningKind::window;
  if (hole.rectangle.width() < params.min_door_width ||
      hole.rectangle.height() < params.min_door_height)
    return std::nullopt;
  return hole.rectangle.width() > params.max_door_width ? OpeningKind::passage : OpeningKind::door;
}

Opening described(const WallHole& hole, OpeningKind kind) {
  Opening opening;
  const OpeningRectangle& r = hole.rectangle;
  opening.kind = kind;
  opening.width = r.width();
  opening.height = r.height();
  opening.sill = hole.has_sill ? r.bottom - hole.front.floor : 0.0;
  opening.thickness = hole.thickness;
  const Eigen::Vector2d middle =
      hole.centre + 0.5 * (r.left + r.right) * hole.tangent + 0.5 * hole.thickness * hole.inwards;
  opening.position = {middle.x(), middle.y(), 0.5 * (r.bottom + r.top)};
  opening.across = {hole.inwards.x(), hole.inwards.y(), 0};
  for (const std::int32_t region : hole.regions)
    if (region >= 0) opening.rooms.push_back(static_cast<std::size_t>(region));
  return opening;
}

}  // namespace

const char* name(OpeningKind kind) {
  switch (kind) {
    case OpeningKind::door:
      return "door";
    case OpeningKind::window:
      return "window";
    case OpeningKind::passage:
      return "passage";
  }
  return "unknown";
}

OpeningSet find_openings(const Cloud& plan, const FloorGrid& grid,
                         const std::vector<WallFace>& faces,
                         const std::vector<RegionFace>& region_faces, const FaceSamples& samples,
                         const std::vector<FaceOpening>& holes, const RoomRegions& regions,
                         const OpeningParams& params) {
  OpeningSet result;
  std::vector<WallHole> walls = wall_holes(faces, holes, params.max_thickness);
  const auto points = points_in_walls(plan, grid, walls, params.max_thickness);
  for (std::size_t h = 0; h < walls.size(); ++h) {
    WallHole& hole = walls[h];
    if (!hole.back) hole.thickness = thickness_behind(hole, points[h], params.max_thickness);
    find_regions(hole, grid, regions);
    if (joins_regions(hole, faces, region_faces, params)) {
      result.joined_regions.emplace_back(std::minmax(
          {static_cast<std::size_t>(hole.regions[0]), static_cast<std::size_t>(hole.regions[1])}));
      continue;
    }
    const double sill = hole.rectangle.bottom - hole.front.floor;
    hole.has_sill =
        sill > params.max_unseen_sill || (sill > params.min_sill && hole.front.parapet > 0.1);
    const OpeningEvidence evidence = evidence_of(hole, faces, samples, points[h]);
    hole.rectangle = refined(hole.rectangle, evidence, hole.has_sill, params.edges);
    const OpeningFrame reveals = frame_of_reveals(hole.rectangle, evidence.reveal);
    hole.frame.left = hole.frame.left || reveals.left;
    hole.frame.right = hole.frame.right || reveals.right;
    hole.frame.above = hole.frame.above || reveals.above;
    if (!hole.has_sill) hole.rectangle.bottom = hole.front.floor;
    if (hole.thickness <= 0)
      hole.thickness = thickness_of_reveals(hole.rectangle, points[h], params.max_thickness);
    if (const auto kind = kind_of(hole, params); kind && hole.regions[0] + hole.regions[1] > -2)
      result.openings.push_back(described(hole, *kind));
  }
  return result;
}

}  // namespace planum
