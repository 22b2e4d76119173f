#include "labeling/rooms/hole_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "labeling/plan/cell_lists.hpp"

namespace planum {
namespace {

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

/// On which edges of an opening a point of its reveal lies.
OpeningFrame edges_of(const OpeningRectangle& r, const OpeningSample& s) {
  constexpr double near = 0.03, facing = 0.7;
  OpeningFrame on;
  if (s.u < r.left - near || s.u > r.right + near || s.z > r.top + near) return on;
  on.left = s.u < r.left + near && s.normal_u > facing;
  on.right = s.u > r.right - near && s.normal_u < -facing;
  on.above = s.z > r.top - near && s.normal_z < -facing;
  return on;
}

}  // namespace

std::vector<std::vector<PointInWall>> points_in_walls(const Cloud& plan, const FloorGrid& grid,
                                                      const std::vector<WallHole>& holes,
                                                      double max_thickness) {
  constexpr double reach = 0.4;  // m beside the opening
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
  for (std::size_t h = 0; h < holes.size(); ++h) {
    const WallHole& hole = holes[h];
    const double end = hole.back ? hole.thickness : max_thickness;
    for (double depth = 0; depth <= end + grid.cell; depth += 0.5 * grid.cell) {
      const Eigen::Vector2d middle = hole.centre + depth * hole.inwards;
      for_each_cell_between(
          grid, middle + (hole.rectangle.left - reach) * hole.tangent,
          middle + (hole.rectangle.right + reach) * hole.tangent, [&](std::size_t cell) {
            cells.emplace_back(static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(h));
          });
    }
  }
  const CellLists holes_at(grid.size(), std::move(cells));
  std::vector<std::vector<PointInWall>> result(holes.size());
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    const Eigen::Vector2d p = plan.points[i].head<2>().cast<double>();
    const std::ptrdiff_t cell = grid.find(p);
    if (cell < 0) continue;
    for (const std::uint32_t h : holes_at.at(static_cast<std::size_t>(cell))) {
      const Eigen::Vector3d n = plan.normals[i].cast<double>();
      result[h].push_back(
          {{holes[h].u_of(p), double{plan.points[i].z()}, holes[h].tangent.dot(n.head<2>()), n.z()},
           holes[h].depth_of(p),
           holes[h].inwards.dot(n.head<2>())});
    }
  }
  return result;
}

double thickness_behind(const WallHole& hole, const std::vector<PointInWall>& points,
                        double max_thickness) {
  constexpr double spread = 0.03, min_depth = 0.04;  // m
  constexpr std::size_t min_count = 30;
  const OpeningRectangle& r = hole.rectangle;
  std::vector<double> depths;
  for (const PointInWall& p : points) {
    const bool beside = p.sample.u < r.left || p.sample.u > r.right || p.sample.z > r.top;
    if (beside && p.normal_depth > 0.9 && p.depth > min_depth && p.depth < max_thickness)
      depths.push_back(p.depth);
  }
  std::sort(depths.begin(), depths.end());
  for (std::size_t i = 0, end = 0; i < depths.size(); ++i) {
    while (end < depths.size() && depths[end] < depths[i] + spread) ++end;
    if (end - i < min_count || 4 * (end - i) < depths.size()) continue;
    // The middle of the first cluster, which may begin with a few strays.
    const double rough = depths[i + (end - i) / 2];
    double sum = 0, count = 0;
    for (const double d : depths)
      if (std::abs(d - rough) < spread) {
        sum += d;
        count += 1;
      }
    return sum / count;
  }
  return 0;
}

double thickness_of_reveals(const OpeningRectangle& rectangle,
                            const std::vector<PointInWall>& points, double max_thickness) {
  constexpr double clearance = 0.05;  // m
  constexpr std::size_t min_count = 30;
  std::vector<double> depths;
  for (const PointInWall& p : points) {
    const OpeningFrame on = edges_of(rectangle, p.sample);
    if (p.depth > 0 && (on.left || on.right || on.above)) depths.push_back(p.depth);
  }
  if (depths.size() < min_count) return 0;
  const auto most = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() * 49 / 50);
  std::nth_element(depths.begin(), most, depths.end());
  // Where it goes on beyond, it is another wall.
  return *most < max_thickness - clearance ? *most : 0;
}

OpeningFrame frame_of_reveals(const OpeningRectangle& rectangle,
                              const std::vector<OpeningSample>& reveal) {
  constexpr int min_count = 12;
  int left = 0, right = 0, above = 0;
  for (const OpeningSample& s : reveal) {
    const OpeningFrame on = edges_of(rectangle, s);
    left += on.left;
    right += on.right;
    above += on.above;
  }
  return {left >= min_count, right >= min_count, above >= min_count};
}

OpeningEvidence evidence_of(const WallHole& hole, const std::vector<WallFace>& faces,
                            const FaceSamples& samples, const std::vector<PointInWall>& points) {
  constexpr double inset = 0.02, unknown_thickness = 0.12;  // m
  OpeningEvidence evidence;
  for (const auto& side : {std::optional(hole.front), hole.back}) {
    if (!side) continue;
    const WallFace& face = faces[side->face];
    add_samples(hole, face, samples_of_face(samples.hits, side->face), evidence.hits);
    add_samples(hole, face, samples_of_face(samples.crossings, side->face), evidence.crossings);
  }
  const double end = hole.thickness > 0 ? hole.thickness - inset : unknown_thickness;
  for (const PointInWall& p : points)
    if (p.depth > inset && p.depth < end) evidence.reveal.push_back(p.sample);
  return evidence;
}

}  // namespace planum
