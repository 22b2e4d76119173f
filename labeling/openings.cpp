#include "labeling/openings.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "labeling/cell_lists.hpp"

namespace planum {
namespace {

/// A hole in a wall with one or two faces. u runs along the tangent of the first face from
/// `centre`, which lies on that face; depth runs into the wall.
struct WallHole {
  FaceOpening front;
  std::optional<FaceOpening> back;
  Eigen::Vector2d centre, tangent, inwards;
  double thickness = 0;  ///< m; 0 where the back is not known
  OpeningRectangle rectangle;
  bool has_sill = false;
  std::array<std::int32_t, 2> regions{-1, -1};  ///< in front and behind, or -1

  double u_of(const Eigen::Vector2d& p) const { return tangent.dot(p - centre); }
  double depth_of(const Eigen::Vector2d& p) const { return inwards.dot(p - centre); }
};

/// How much of the shorter of two intervals they share.
double overlap(double a0, double a1, double b0, double b1) {
  return (std::min(a1, b1) - std::max(a0, b0)) / std::min(a1 - a0, b1 - b0);
}

/// The same hole seen from the other side of the wall?
std::optional<double> thickness_between(const std::vector<WallFace>& faces, const FaceOpening& a,
                                        const FaceOpening& b, double max_thickness) {
  const WallFace& front = faces[a.face];
  const WallFace& back = faces[b.face];
  if (front.normal.dot(back.normal) > -0.98) return std::nullopt;
  const double thickness = -front.signed_distance(back.at(0.5 * (b.begin + b.end)));
  if (thickness < 0.01 || thickness > max_thickness) return std::nullopt;
  const double b0 = front.tangent().dot(back.at(b.end));
  const double b1 = front.tangent().dot(back.at(b.begin));
  if (overlap(a.begin, a.end, b0, b1) < 0.6 || overlap(a.bottom, a.top, b.bottom, b.top) < 0.6)
    return std::nullopt;
  return thickness;
}

std::vector<WallHole> paired(const std::vector<WallFace>& faces,
                             const std::vector<FaceOpening>& holes, double max_thickness) {
  std::vector<WallHole> result;
  std::vector<std::uint8_t> used(holes.size(), 0);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (used[i]) continue;
    WallHole hole;
    hole.front = holes[i];
    std::size_t partner = holes.size();
    for (std::size_t k = i + 1; k < holes.size(); ++k) {
      if (used[k]) continue;
      const auto thickness = thickness_between(faces, holes[i], holes[k], max_thickness);
      if (!thickness || (partner < holes.size() && *thickness >= hole.thickness)) continue;
      partner = k;
      hole.thickness = *thickness;
    }
    if (partner < holes.size()) {
      used[partner] = 1;
      hole.back = holes[partner];
    }
    const WallFace& face = faces[hole.front.face];
    hole.centre = face.at(0.5 * (holes[i].begin + holes[i].end));
    hole.tangent = face.tangent();
    hole.inwards = -face.normal;
    const double half = 0.5 * (holes[i].end - holes[i].begin);
    hole.rectangle = {-half, half, holes[i].bottom, holes[i].top};
    result.push_back(hole);
  }
  return result;
}

/// Samples of one face around the hole, in its frame.
void add_samples(const WallHole& hole, const WallFace& face, std::span<const FaceSample> samples,
                 std::vector<OpeningSample>& to) {
  constexpr double reach = 0.5;  // m
  for (const FaceSample& s : samples) {
    const double u = hole.u_of(face.at(double{s.along}));
    if (u > hole.rectangle.left - reach && u < hole.rectangle.right + reach)
      to.push_back({u, double{s.height}, 0, 0});
  }
}

std::vector<OpeningEvidence> evidence_of(const Cloud& plan, const FloorGrid& grid,
                                         const std::vector<WallFace>& faces, const FreeSpace& space,
                                         const std::vector<WallHole>& holes) {
  constexpr double reach = 0.2, inset = 0.02, unknown_thickness = 0.12;  // m
  std::vector<OpeningEvidence> evidence(holes.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    const WallHole& hole = holes[h];
    for (const auto& side : {std::optional(hole.front), hole.back}) {
      if (!side) continue;
      const WallFace& face = faces[side->face];
      add_samples(hole, face, samples_of_face(space.hits, side->face), evidence[h].hits);
      add_samples(hole, face, samples_of_face(space.crossings, side->face), evidence[h].crossings);
    }
    const double depth = hole.back ? hole.thickness : unknown_thickness;
    for (double d = 0; d <= depth + grid.cell; d += 0.5 * grid.cell) {
      const Eigen::Vector2d middle = hole.centre + d * hole.inwards;
      for_each_cell_between(
          grid, middle + (hole.rectangle.left - reach) * hole.tangent,
          middle + (hole.rectangle.right + reach) * hole.tangent, [&](std::size_t cell) {
            cells.emplace_back(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(h));
          });
    }
  }
  const CellLists holes_at(grid.size(), std::move(cells));
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const Eigen::Vector2d p = plan.points[i].head<2>().cast<double>();
    const std::ptrdiff_t cell = grid.find(p);
    if (cell < 0) continue;
    for (const std::uint32_t h : holes_at.at(static_cast<std::size_t>(cell))) {
      const double depth = holes[h].depth_of(p);
      const double end = holes[h].back ? holes[h].thickness - inset : unknown_thickness;
      if (depth < inset || depth > end) continue;
      const Eigen::Vector3d n = plan.normals[i].cast<double>();
      evidence[h].reveal.push_back(
          {holes[h].u_of(p), double{plan.points[i].z()}, holes[h].tangent.dot(n.head<2>()), n.z()});
    }
  }
  return evidence;
}

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
  const bool framed = hole.front.framed || (hole.back && hole.back->framed);
  if (!framed) return std::nullopt;
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
                         const std::vector<RegionFace>& region_faces, const FreeSpace& space,
                         const std::vector<FaceOpening>& holes, const RoomRegions& regions,
                         const OpeningParams& params) {
  OpeningSet result;
  std::vector<WallHole> walls = paired(faces, holes, params.max_thickness);
  const std::vector<OpeningEvidence> evidence = evidence_of(plan, grid, faces, space, walls);
  for (std::size_t h = 0; h < walls.size(); ++h) {
    WallHole& hole = walls[h];
    find_regions(hole, grid, regions);
    if (joins_regions(hole, faces, region_faces, params)) {
      result.joined_regions.emplace_back(std::minmax(static_cast<std::size_t>(hole.regions[0]),
                                                     static_cast<std::size_t>(hole.regions[1])));
      continue;
    }
    const double sill = hole.rectangle.bottom - hole.front.floor;
    hole.has_sill =
        sill > params.max_unseen_sill || (sill > params.min_sill && hole.front.parapet > 0.1);
    hole.rectangle = refined(hole.rectangle, evidence[h], hole.has_sill, params.edges);
    if (!hole.has_sill) hole.rectangle.bottom = hole.front.floor;
    if (const auto kind = kind_of(hole, params); kind && hole.regions[0] + hole.regions[1] > -2)
      result.openings.push_back(described(hole, *kind));
  }
  return result;
}

}  // namespace planum
