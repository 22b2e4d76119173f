#include "labeling/rooms/free_space.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <optional>

#include "labeling/plan/cell_lists.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t rays_per_block = 1 << 13;

/// The same plan in cells of about this size: few steps for a ray that only looks for walls.
constexpr double coarse_cell = 0.4;  // m

FloorGrid coarse(const FloorGrid& grid) {
  FloorGrid result = grid;
  result.cell = std::max(grid.cell, coarse_cell);
  result.columns = static_cast<int>(std::ceil(grid.columns * grid.cell / result.cell)) + 1;
  result.rows = static_cast<int>(std::ceil(grid.rows * grid.cell / result.cell)) + 1;
  return result;
}

/// The faces in or near each cell.
CellLists faces_of_cells(const FloorGrid& grid, const std::vector<WallFace>& faces, double margin) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (const double side : {-margin, margin}) {
      const Eigen::Vector2d shift = side * faces[f].normal;
      for_each_cell_between(grid, faces[f].at(faces[f].begin - margin) + shift,
                            faces[f].at(faces[f].end + margin) + shift, [&](std::size_t cell) {
                              pairs.emplace_back(static_cast<std::uint32_t>(cell),
                                                 static_cast<std::uint32_t>(f));
                            });
    }
  return CellLists(grid.size(), std::move(pairs));
}

/// Where the ray crosses the face, if it ends far enough on the other side.
std::optional<FaceSample> crossing(const WallFace& face, std::uint32_t index,
                                   const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                                   double overshoot, double end_reach) {
  const double from = face.signed_distance(origin.head<2>());
  const double to = face.signed_distance(end.head<2>());
  if (from * to >= 0 || std::abs(to) < overshoot || std::abs(from) < overshoot) return std::nullopt;
  const Eigen::Vector3d at = origin + (end - origin) * (from / (from - to));
  const double along = face.tangent().dot(at.head<2>());
  if (along < face.begin - end_reach || along > face.end + end_reach) return std::nullopt;
  return FaceSample{index, static_cast<float>(along), static_cast<float>(at.z())};
}

void mark_free(const FloorGrid& grid, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
               double end_margin, CellMask& free) {
  const double length = (b - a).norm();
  if (length <= end_margin) return;
  const Eigen::Vector2d stop = a + (b - a) * (1 - end_margin / length);
  for_each_cell_between(grid, a, stop, [&](std::size_t cell) {
    // All writers store the same value; atomic only because they may meet.
    std::atomic_ref<std::uint8_t>(free[cell]).store(1, std::memory_order_relaxed);
  });
}

/// Finds the faces that a ray goes through, and those it ends on.
struct FaceFinder {
  const FloorGrid& grid;  ///< coarse
  const std::vector<WallFace>& faces;
  const CellLists& faces_at;
  const RayParams& params;

  void find_crossings(const Eigen::Vector3d& origin, const Eigen::Vector3d& end,
                      std::vector<FaceSample>& found) const {
    const auto before = static_cast<std::ptrdiff_t>(found.size());
    for_each_cell_between(grid, origin.head<2>(), end.head<2>(), [&](std::size_t cell) {
      for (const std::uint32_t f : faces_at.at(cell)) {
        const auto sample = crossing(faces[f], f, origin, end, params.overshoot, params.end_reach);
        if (!sample) continue;
        const auto known = [&](const FaceSample& other) { return other.face == f; };
        if (std::none_of(found.begin() + before, found.end(), known)) found.push_back(*sample);
      }
    });
  }

  void find_hits(const Eigen::Vector3d& end, std::vector<FaceSample>& found) const {
    const std::ptrdiff_t cell = grid.find(end.head<2>());
    if (cell < 0) return;
    for (const std::uint32_t f : faces_at.at(static_cast<std::size_t>(cell))) {
      const WallFace& face = faces[f];
      if (std::abs(face.signed_distance(end.head<2>())) > params.hit_distance) continue;
      const double along = face.tangent().dot(end.head<2>());
      if (along >= face.begin - params.end_reach && along <= face.end + params.end_reach)
        found.push_back({f, static_cast<float>(along), static_cast<float>(end.z())});
    }
  }
};

/// The samples of all blocks, sorted by face, else in their order.
std::vector<FaceSample> joined(const std::vector<std::vector<FaceSample>>& of_block,
                               std::size_t faces) {
  std::vector<std::size_t> next(faces + 1, 0);
  for (const std::vector<FaceSample>& block : of_block)
    for (const FaceSample& sample : block) ++next[sample.face + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<FaceSample> result(next.back());
  for (const std::vector<FaceSample>& block : of_block)
    for (const FaceSample& sample : block) result[next[sample.face]++] = sample;
  return result;
}

}  // namespace

CellMask free_cells(const Cloud& plan, std::span<const Eigen::Vector3d> origins,
                    const FloorGrid& grid, const RayParams& params) {
  CellMask free(grid.size(), 0);
  const std::size_t step = 1 + plan.points.size() / std::max<std::size_t>(params.max_free_rays, 1);
  parallel_for(plan.points.size(), rays_per_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = (begin + step - 1) / step * step; i < end; i += step)
      mark_free(grid, origins[plan.scan[i]].head<2>(), plan.points[i].head<2>().cast<double>(),
                params.end_margin, free);
  });
  return free;
}

CellMask wall_cells(const FloorGrid& grid, const std::vector<WallFace>& faces) {
  CellMask mask(grid.size(), 0);
  for (const WallFace& face : faces)
    for_each_cell_between(grid, face.at(face.begin), face.at(face.end),
                          [&](std::size_t cell) { mask[cell] = 1; });
  return mask;
}

FaceSamples sample_faces(const Cloud& plan, std::span<const Eigen::Vector3d> origins,
                         const FloorGrid& grid, const std::vector<WallFace>& faces,
                         const RayParams& params) {
  const FloorGrid wide = coarse(grid);
  const CellLists faces_at = faces_of_cells(wide, faces, params.end_reach);
  const FaceFinder finder{wide, faces, faces_at, params};
  const std::size_t count = plan.points.size();
  const std::size_t blocks = (count + rays_per_block - 1) / rays_per_block;
  std::vector<std::vector<FaceSample>> crossings(blocks), hits(blocks);
  parallel_for(count, rays_per_block, [&](std::size_t begin, std::size_t end) {
    const std::size_t block = begin / rays_per_block;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = plan.points[i].cast<double>();
      finder.find_crossings(origins[plan.scan[i]], point, crossings[block]);
      finder.find_hits(point, hits[block]);
    }
  });
  return {joined(crossings, faces.size()), joined(hits, faces.size())};
}

std::span<const FaceSample> samples_of_face(const std::vector<FaceSample>& samples,
                                            std::size_t face) {
  const auto before = [](const FaceSample& s, std::size_t f) { return s.face < f; };
  const auto first = std::lower_bound(samples.begin(), samples.end(), face, before);
  const auto last = std::lower_bound(first, samples.end(), face + 1, before);
  return {first, last};
}

}  // namespace planum
