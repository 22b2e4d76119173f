#include "labeling/rooms/wall_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "labeling/plan/cell_lists.hpp"

namespace planum {
namespace {

/// The point as one on an upright surface, if it is.
std::optional<WallPoint> upright(const Cloud& plan, std::size_t i, double max_normal_z) {
  const Eigen::Vector3d n = plan.normals[i].cast<double>();
  const double horizontal = n.head<2>().norm();
  if (std::abs(n.z()) > max_normal_z || horizontal < 0.5) return std::nullopt;
  return WallPoint{plan.points[i].head<2>().cast<double>(), n.head<2>() / horizontal,
                   double{plan.points[i].z()}};
}

/// Height of the ceiling in front of a wall point, or nan.
double ceiling_before(const LevelSurface& ceiling, const FloorGrid& grid, const WallPoint& p) {
  for (const double distance : {0.08, 0.15, 0.25, 0.4}) {
    const std::ptrdiff_t cell = grid.find(p.position + distance * p.normal);
    if (cell < 0) break;
    const float height = ceiling.height[static_cast<std::size_t>(cell)];
    if (!std::isnan(height)) return double{height};
  }
  const std::ptrdiff_t cell = grid.find(p.position + 0.15 * p.normal);
  return cell < 0 ? std::numeric_limits<double>::quiet_NaN()
                  : double{ceiling.nearest[static_cast<std::size_t>(cell)]};
}

bool ceiling_behind(const LevelSurface& ceiling, const FloorGrid& grid, const WallPoint& p) {
  for (const double distance : {0.05, 0.09}) {
    const std::ptrdiff_t cell = grid.find(p.position - distance * p.normal);
    if (cell >= 0 && !std::isnan(ceiling.height[static_cast<std::size_t>(cell)])) return true;
  }
  return false;
}

CellLists faces_near_cells(const FloorGrid& grid, const std::vector<WallFace>& faces,
                           double margin) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (double shift = -margin; shift <= margin; shift += 0.5 * grid.cell) {
      const Eigen::Vector2d across = shift * faces[f].normal;
      for_each_cell_between(grid, faces[f].at(faces[f].begin - margin) + across,
                            faces[f].at(faces[f].end + margin) + across, [&](std::size_t cell) {
                              pairs.emplace_back(static_cast<std::uint32_t>(cell),
                                                 static_cast<std::uint32_t>(f));
                            });
    }
  return CellLists(grid.size(), std::move(pairs));
}

}  // namespace

std::vector<WallPoint> points_below_ceiling(const Cloud& plan, const FloorGrid& grid,
                                            const LevelSurface& ceiling,
                                            const WallPointParams& params) {
  const double max_z = std::sin(params.max_tilt);
  std::vector<WallPoint> result;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const std::optional<WallPoint> p = upright(plan, i, max_z);
    if (!p) continue;
    const double below = ceiling_before(ceiling, grid, *p) - p->height;
    if (below >= params.band_gap && below <= params.band) result.push_back(*p);
  }
  return result;
}

std::vector<WallPoint> points_lower_down(const Cloud& plan, const FloorGrid& grid,
                                         const LevelSurface& floor, const LevelSurface& ceiling,
                                         const std::vector<WallFace>& known,
                                         const WallPointParams& params) {
  constexpr double margin = 0.12;  // m around known faces
  const CellLists known_at = faces_near_cells(grid, known, margin);
  const double max_z = std::sin(params.max_tilt);
  std::vector<WallPoint> result;
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const std::optional<WallPoint> p = upright(plan, i, max_z);
    if (!p) continue;
    const std::ptrdiff_t c = grid.find(p->position);
    if (c < 0) continue;
    const auto cell = static_cast<std::size_t>(c);
    const double above_floor = p->height - double{floor.nearest[cell]};
    const double below_ceiling = double{ceiling.nearest[cell]} - p->height;
    if (!(above_floor > params.min_height) || !(below_ceiling > params.band_gap)) continue;
    const auto same_side = [&](std::uint32_t f) { return known[f].normal.dot(p->normal) > 0.7; };
    const auto near = known_at.at(cell);
    if (std::any_of(near.begin(), near.end(), same_side) || ceiling_behind(ceiling, grid, *p))
      continue;
    result.push_back(*p);
  }
  return result;
}

bool is_wall(const WallFace& face, const std::vector<WallPoint>& points, const FloorGrid& grid,
             const LevelSurface& floor, const CellMask& free, const WallPointParams& params) {
  constexpr double bin = 0.1;      // m along the face
  constexpr double behind = 0.08;  // m, within the thinnest wall
  if (face.length() < params.min_piece) return false;
  std::vector<double> top(static_cast<std::size_t>(face.length() / bin) + 1, -1e30);
  for (const WallPoint& p : points) {
    const double along = face.tangent().dot(p.position);
    if (along < face.begin || along > face.end || std::abs(face.signed_distance(p.position)) > 0.05)
      continue;
    const std::ptrdiff_t cell = grid.find(p.position);
    if (cell < 0) continue;
    double& highest = top[static_cast<std::size_t>((along - face.begin) / bin)];
    highest = std::max(highest, p.height - double{floor.nearest[static_cast<std::size_t>(cell)]});
  }
  std::size_t high = 0, free_behind = 0;
  for (std::size_t i = 0; i < top.size(); ++i) {
    high += top[i] > params.min_top;
    const double along = face.begin + (static_cast<double>(i) + 0.5) * bin;
    const std::ptrdiff_t cell = grid.find(face.at(along) - behind * face.normal);
    free_behind += cell >= 0 && free[static_cast<std::size_t>(cell)];
  }
  if (2 * high >= top.size()) return true;
  return face.length() > params.min_length && 5 * free_behind <= top.size() &&
         *std::max_element(top.begin(), top.end()) > params.min_end_top;
}

}  // namespace planum
