#include "labeling/rooms/wall_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace planum {
namespace {

constexpr double same_plane = 0.05;  // m between two faces at the gap
constexpr double same_normal = 0.99;

/// The next face on the same plane beyond the end of a face, or the number of faces.
std::size_t next_on_plane(const std::vector<WallFace>& faces, std::size_t f, double max_gap) {
  const WallFace& face = faces[f];
  std::size_t best = faces.size();
  double best_gap = max_gap;
  for (std::size_t other = 0; other < faces.size(); ++other) {
    const WallFace& o = faces[other];
    if (other == f || o.normal.dot(face.normal) < same_normal) continue;
    const Eigen::Vector2d begin = o.at(o.begin);
    if (std::abs(face.signed_distance(begin)) > same_plane ||
        std::abs(o.signed_distance(face.at(face.end))) > same_plane)
      continue;
    const double gap = face.tangent().dot(begin) - face.end;
    if (gap > 0 && gap < best_gap) {
      best_gap = gap;
      best = other;
    }
  }
  return best;
}

/// How far rays went through the wall's plane beyond the end of a face (sign +1) or before its
/// begin
/// (-1): the place along the face where that ends, if it does within max_gap.
std::optional<double> end_of_free_run(const WallFace& face, double sign, const FloorGrid& grid,
                                      const CellMask& free, double max_gap) {
  constexpr double depth = 0.075;    // m, inside the wall: rays that end on it do not get there
  constexpr double max_lead = 0.20;  // m of wall between what was seen of the face and the gap
  constexpr int end_cells = 2;       // that no ray passed
  double free_end = 0;               // m beyond the end of the face
  int blocked = 0;
  for (double t = 0.5 * grid.cell; t < max_gap + max_lead; t += grid.cell) {
    const double along = sign > 0 ? face.end + t : face.begin - t;
    const std::ptrdiff_t cell = grid.find(face.at(along) - depth * face.normal);
    if (cell >= 0 && free[static_cast<std::size_t>(cell)]) {
      free_end = t + 0.5 * grid.cell;
      blocked = 0;
    } else if (free_end > 0 ? ++blocked == end_cells : t > max_lead) {
      break;
    }
  }
  if (free_end <= 0 || blocked < end_cells) return std::nullopt;
  return sign > 0 ? face.end + free_end : face.begin - free_end;
}

/// Is there a wall above the gap: seen by its lintel, or at least not seen to be missing?
bool wall_above(const WallFace& face, double from, double to, const FloorGrid& grid,
                const LevelSurface& ceiling, const CellMask& lintels, const WallGapParams& params) {
  int steps = 0, with_lintel = 0, with_ceiling = 0;
  for (double along = from + 0.5 * grid.cell; along < to; along += grid.cell) {
    ++steps;
    bool lintel = false, seen = false;
    for (const double depth : {0.0, 0.05, 0.1}) {
      const std::ptrdiff_t cell = grid.find(face.at(along) - depth * face.normal);
      if (cell < 0) continue;
      const auto c = static_cast<std::size_t>(cell);
      lintel = lintel || lintels[c];
      // In the wall's own cells the ceiling of the room in front may still show.
      seen = seen || (depth > 0.04 && !std::isnan(ceiling.height[c]));
    }
    with_lintel += lintel;
    with_ceiling += seen;
  }
  if (steps == 0) return true;
  if (with_lintel >= params.min_seen * steps) return true;
  return to - from < params.max_unseen_gap && 10 * with_ceiling <= steps;
}

}  // namespace

CellMask lintel_cells(const Cloud& plan, const FloorGrid& grid, const LevelSurface& floor,
                      const LevelSurface& ceiling, const WallGapParams& params) {
  CellMask mask(grid.size(), 0);
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (!(plan.normals[i].z() < -0.8f)) continue;
    const std::ptrdiff_t c = grid.find(plan.points[i].head<2>().cast<double>());
    if (c < 0) continue;
    const auto cell = static_cast<std::size_t>(c);
    const double z = double{plan.points[i].z()};
    if (z - double{floor.nearest[cell]} > params.min_lintel &&
        double{ceiling.nearest[cell]} - z > params.lintel_gap)
      mask[cell] = 1;
  }
  return mask;
}

std::vector<WallFace> with_door_gaps_closed(std::vector<WallFace> faces, const FloorGrid& grid,
                                            const LevelSurface& ceiling, const CellMask& lintels,
                                            const CellMask& free, const WallGapParams& params) {
  const auto spanned = [&](const WallFace& face, double from, double to) {
    return wall_above(face, from, to, grid, ceiling, lintels, params);
  };
  for (std::size_t f = 0; f < faces.size();) {
    const std::size_t next = next_on_plane(faces, f, params.max_gap);
    if (next == faces.size() ||
        !spanned(faces[f], faces[f].end,
                 faces[f].tangent().dot(faces[next].at(faces[next].begin)))) {
      ++f;
      continue;
    }
    const WallFace other = faces[next];
    const Eigen::Vector2d from = faces[f].at(faces[f].begin), to = other.at(other.end);
    if (other.length() > faces[f].length()) faces[f] = other;
    faces[f].begin = faces[f].tangent().dot(from);
    faces[f].end = faces[f].tangent().dot(to);
    faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(next));
    if (next < f) --f;
  }
  for (WallFace& face : faces) {
    const auto end = end_of_free_run(face, 1, grid, free, params.max_gap);
    if (end && spanned(face, face.end, *end)) face.end = *end;
    const auto begin = end_of_free_run(face, -1, grid, free, params.max_gap);
    if (begin && spanned(face, *begin, face.begin)) face.begin = *begin;
  }
  return faces;
}

}  // namespace planum
