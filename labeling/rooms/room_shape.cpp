#include "labeling/rooms/room_shape.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <optional>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

constexpr double max_turn = radians(8.0);  // between a wall and the room's main direction
constexpr double large_face = 0.4;         // of the longest face on the same side

/// The direction modulo a quarter turn that the longest stretch of walls has.
double main_direction(const std::vector<RegionFace>& own, const std::vector<WallFace>& faces) {
  const auto angle_of = [&](const RegionFace& f) {
    const Eigen::Vector2d& n = faces[f.face].normal;
    return std::atan2(n.y(), n.x());
  };
  const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, pi / 2)); };
  double best = 0, best_length = 0;
  for (const RegionFace& candidate : own) {
    double length = 0;
    for (const RegionFace& f : own)
      if (apart(angle_of(f), angle_of(candidate)) < radians(3.0)) length += f.length();
    if (length > best_length) {
      best_length = length;
      best = angle_of(candidate);
    }
  }
  std::complex<double> sum = 0;
  for (const RegionFace& f : own)
    if (apart(angle_of(f), best) < radians(3.0))
      sum += f.length() * f.length() * std::polar(1.0, 4 * angle_of(f));
  return sum == 0.0 ? 0.0 : std::arg(sum) / 4;
}

/// How far the room reaches from `centre` in a direction: to the outermost large face there.
std::optional<double> reach(const Eigen::Vector2d& centre, const Eigen::Vector2d& direction,
                            const std::vector<RegionFace>& own,
                            const std::vector<WallFace>& faces) {
  struct Candidate {
    double distance, length;
  };
  std::vector<Candidate> candidates;
  for (const RegionFace& f : own) {
    const WallFace& face = faces[f.face];
    const double facing = -face.normal.dot(direction);
    if (facing < std::cos(max_turn)) continue;
    candidates.push_back({face.signed_distance(centre) / facing, f.length()});
  }
  // Pieces of one plane count together.
  double longest = 0;
  for (Candidate& c : candidates) {
    double length = 0;
    for (const Candidate& other : candidates)
      if (std::abs(other.distance - c.distance) < 0.05) length += other.length;
    longest = std::max(longest, length);
  }
  std::optional<double> result;
  double result_length = 0;
  for (const Candidate& c : candidates) {
    double length = 0;
    for (const Candidate& other : candidates)
      if (std::abs(other.distance - c.distance) < 0.05) length += other.length;
    if (length < large_face * longest) continue;
    // Of pieces of one plane the longest is the most exact.
    const bool outermost = !result || c.distance > *result + 0.05;
    const bool same_but_longer =
        result && std::abs(c.distance - *result) <= 0.05 && c.length > result_length;
    if (!outermost && !same_but_longer) continue;
    result = c.distance;
    result_length = c.length;
  }
  return result;
}

/// The interval a ring covers along a direction, relative to `centre`.
std::pair<double, double> extent(const std::vector<Eigen::Vector2d>& ring,
                                 const Eigen::Vector2d& centre, const Eigen::Vector2d& direction) {
  double low = 0, high = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double t = direction.dot(ring[i] - centre);
    low = i == 0 ? t : std::min(low, t);
    high = i == 0 ? t : std::max(high, t);
  }
  return {low, high};
}

/// Height of most of the region's cells, and the share of cells where the surface was seen.
std::pair<double, double> level_of(const FloorGrid& grid, const RoomRegions& regions,
                                   std::size_t region, const LevelSurface& surface) {
  constexpr double bin = 0.04;
  std::vector<double> heights;
  double cells = 0, nearest_sum = 0, nearest_count = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (regions.of_cell[i] != static_cast<std::int32_t>(region)) continue;
    cells += 1;
    if (!std::isnan(surface.height[i])) heights.push_back(double{surface.height[i]});
    if (!std::isnan(surface.nearest[i])) {
      nearest_sum += double{surface.nearest[i]};
      nearest_count += 1;
    }
  }
  if (heights.empty()) return {nearest_count > 0 ? nearest_sum / nearest_count : 0.0, 0.0};
  std::sort(heights.begin(), heights.end());
  std::size_t best = 0, best_count = 0;
  for (std::size_t i = 0, end = 0; i < heights.size(); ++i) {
    while (end < heights.size() && heights[end] < heights[i] + bin) ++end;
    if (end - i > best_count) {
      best_count = end - i;
      best = i;
    }
  }
  double sum = 0;
  for (std::size_t i = best; i < best + best_count; ++i) sum += heights[i];
  return {sum / static_cast<double>(best_count), static_cast<double>(heights.size()) / cells};
}

/// Distance between opposite walls along a direction; moves the centre halfway between them.
double distance_between_walls(RoomShape& shape, const Eigen::Vector2d& direction,
                              const std::vector<RegionFace>& own,
                              const std::vector<WallFace>& faces) {
  const auto [low, high] = extent(shape.outline.outer, shape.centre, direction);
  const double forwards = reach(shape.centre, direction, own, faces).value_or(high);
  const double backwards = reach(shape.centre, -direction, own, faces).value_or(-low);
  shape.centre += 0.5 * (forwards - backwards) * direction;
  return forwards + backwards;
}

}  // namespace

RoomShape measure_room(const FloorGrid& grid, const RoomRegions& regions, std::size_t region,
                       const std::vector<RegionFace>& own_faces, const std::vector<WallFace>& faces,
                       const CellMask& wall, const LevelSurface& floor,
                       const LevelSurface& ceiling) {
  RoomShape shape;
  shape.outline = region_outline(grid, regions, region, own_faces, faces, wall);
  shape.area = shape.outline.area;
  const double turn = main_direction(own_faces, faces);
  const Eigen::Vector2d x(std::cos(turn), std::sin(turn)), y(-x.y(), x.x());
  const auto [left, right] = extent(shape.outline.outer, Eigen::Vector2d::Zero(), x);
  const auto [bottom, top] = extent(shape.outline.outer, Eigen::Vector2d::Zero(), y);
  shape.centre = 0.5 * (left + right) * x + 0.5 * (bottom + top) * y;
  const double along_x = distance_between_walls(shape, x, own_faces, faces);
  const double along_y = distance_between_walls(shape, y, own_faces, faces);
  shape.width = std::min(along_x, along_y);
  shape.depth = std::max(along_x, along_y);
  shape.along = along_x > along_y ? x : y;
  std::tie(shape.floor, shape.floor_share) = level_of(grid, regions, region, floor);
  std::tie(shape.ceiling, shape.ceiling_share) = level_of(grid, regions, region, ceiling);
  return shape;
}

}  // namespace planum
