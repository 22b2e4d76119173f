#include "meshing/normals.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshing/scan_indices.hpp"
#include "meshing/view_patches.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 16;

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
           const NormalParams& params) {
  if (!(params.cell > 0))
    throw Error("normals: cell must be above 0, is " + std::to_string(params.cell));
  if (params.levels < 1 || params.levels > 10)
    throw Error("normals: levels must be 1 to 10, is " + std::to_string(params.levels));
  if (scan_origins.empty())
    throw Error("normals: no scan origins: which side of a surface is free cannot be told");
  check_scan_indices(cloud, scan_origins.size(), "normals");
}

/// Planes that points of one cell may belong to, those of one surface as one.
class Candidates {
 public:
  /// Collects the planes of the cells around one; `at` is its place in its block, and `middle` its
  /// middle relative to the lattice's origin.
  void read(const PatchGrid& grid, const std::vector<PatchPlane>& planes,
            const std::vector<std::uint32_t>& first, const Eigen::Vector3i& at,
            const Eigen::Vector3f& middle) {
    merged_.clear();
    for_patches_around(grid, first, at, [&](std::uint32_t patch) {
      if (planes[patch].weight > 0) add(planes[patch], middle);
    });
    middle_ = middle;
    for (Merged& merged : merged_) {
      merged.mean = merged.normal.normalized();
      merged.offset /= merged.weight;
      merged.variance /= merged.weight;
    }
  }

  /// The average of the planes that explain a point; zero if none does.
  Eigen::Vector3f normal_of(const Eigen::Vector3f& point, const Eigen::Vector3f& view,
                            float max_scatter) {
    constexpr float grazing = -0.1f;     // how far a scanner may seem behind a plane
    constexpr float same_plane = 0.87f;  // cosine, about 30 degrees
    const Merged* best = nullptr;
    float most = 0;
    for (Merged& plane : merged_) {
      plane.share = 0;
      const float distance = plane.mean.dot(point - middle_) - plane.offset;
      const float ratio = distance * distance / plane.variance;
      if (ratio > 9 && std::abs(distance) > max_scatter) continue;
      if (plane.mean.dot(view) < grazing) continue;
      plane.share = std::exp(-0.5f * ratio) * plane.weight / plane.variance;
      if (plane.share > most) most = plane.share, best = &plane;
    }
    if (best == nullptr) return Eigen::Vector3f::Zero();
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Merged& plane : merged_)
      if (plane.share > 0 && plane.mean.dot(best->mean) > same_plane)
        sum += plane.share * plane.mean;
    return sum.normalized();
  }

 private:
  /// Planes that agree, as sums weighted by `weight`, later means.
  struct Merged {
    Eigen::Vector3f normal;  ///< sum
    Eigen::Vector3f mean;    ///< unit
    float offset;            ///< m, from the middle of the cell
    float variance, weight;
    float share;  ///< in the normal of the point at hand
  };

  void add(const PatchPlane& plane, const Eigen::Vector3f& middle) {
    constexpr float same_direction = 0.995f;  // cosine, about 6 degrees
    constexpr float most_apart = 0.5f;        // standard deviations
    const float offset = plane.offset - plane.normal.dot(middle);
    for (Merged& merged : merged_) {
      const float apart = offset - merged.offset / merged.weight;
      if (merged.normal.dot(plane.normal) < same_direction * merged.weight ||
          apart * apart > most_apart * most_apart * plane.variance)
        continue;
      merged.normal += plane.weight * plane.normal;
      merged.offset += plane.weight * offset;
      merged.variance += plane.weight * plane.variance;
      merged.weight += plane.weight;
      return;
    }
    merged_.push_back({plane.weight * plane.normal, plane.normal, plane.weight * offset,
                       plane.weight * plane.variance, plane.weight, 0});
  }

  std::vector<Merged> merged_;
  Eigen::Vector3f middle_;
};

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(const Cloud& cloud,
                                              std::span<const Eigen::Vector3d> scan_origins,
                                              const NormalParams& params,
                                              const Progress& progress) {
  check(cloud, scan_origins, params);
  std::vector<Eigen::Vector3f> normals(cloud.points.size(), Eigen::Vector3f::Zero());
  Lattice lattice = lattice_around(cloud.points, params.cell);
  std::vector<CellKey> cells = cell_keys(lattice, cloud.points);
  CellSort sorted = sort_by_cell(cells);
  PatchGrid grid = view_patches(lattice, sorted, cells, cloud, scan_origins);
  for (int level = 0; level < params.levels; ++level) {
    if (level > 0) grid = coarser(grid);
    const std::vector<PatchPlane> planes = patch_planes(grid, params);
    parallel_for(sorted.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> first;
      Candidates candidates;
      for (std::size_t b = begin; b < end; ++b) {
        const CellKey block = sorted.blocks.key(b);
        surrounding_cells(grid.blocks, grid.begin, grid.cells, block, 1, first);
        CellKey cell = no_cell;
        for (std::uint32_t k = sorted.begin[b]; k < sorted.begin[b + 1]; ++k) {
          const std::uint32_t i = sorted.order[k];
          if (cells[i] != cell) {
            cell = cells[i];
            const Eigen::Vector3d middle =
                grid.lattice.size * (cell_of(cell).cast<double>().array() + 0.5);
            candidates.read(grid, planes, first, cell_of(cell) - cell_of(block),
                            middle.cast<float>());
          }
          const std::size_t scan = cloud.scan.empty() ? 0 : cloud.scan[i];
          const Eigen::Vector3d point = cloud.points[i].cast<double>();
          normals[i] = candidates.normal_of((point - lattice.origin).cast<float>(),
                                            (scan_origins[scan] - point).cast<float>().normalized(),
                                            float(params.max_scatter));
        }
      }
    });
    progress.report(std::size_t(level + 1), std::size_t(params.levels));
    if (level + 1 == params.levels) break;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i] == no_cell) continue;
      const Eigen::Vector3i cell = cell_of(cells[i]);
      cells[i] =
          normals[i].isZero() ? cell_key(cell.x() >> 1, cell.y() >> 1, cell.z() >> 1) : no_cell;
    }
    sorted = sort_by_cell(cells);
    if (sorted.order.empty()) break;
  }
  return normals;
}

}  // namespace planum
