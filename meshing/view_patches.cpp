#include "meshing/view_patches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t blocks_per_task = 16;

/// Added to the variance of planes, so that noise-free data cannot have infinite weights.
constexpr double least_variance = 1e-6;  // m^2

/// A patch whose middle is this many standard deviations off the plane is left out.
constexpr double most_deviations = 1.3;
constexpr int trimming_rounds = 3;

void add_point(ViewPatch& patch, const Eigen::Vector3d& p) {
  const std::array<double, 10> terms = {1,
                                        p.x(),
                                        p.y(),
                                        p.z(),
                                        p.x() * p.x(),
                                        p.x() * p.y(),
                                        p.x() * p.z(),
                                        p.y() * p.y(),
                                        p.y() * p.z(),
                                        p.z() * p.z()};
  for (std::size_t k = 0; k < 10; ++k) patch.moments[k] += terms[k];
}

void add_moments(std::array<double, 10>& to, const std::array<double, 10>& from) {
  for (std::size_t k = 0; k < 10; ++k) to[k] += from[k];
}

/// The mean direction of those views that agree with the first: the side of a patch; views against
/// it are those of the other side.
Eigen::Vector3f first_side(std::span<const Eigen::Vector3f> views) {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& view : views)
    if (view.dot(views.front()) > 0) mean += view;
  return mean;
}

/// Patches of the items of one block, which are sorted by cell: `view(item)` is where an item is
/// seen from, `add(item, patch)` puts it into its patch.
template <class View, class Add>
void make_patches(std::span<const std::uint32_t> items, std::span<const CellKey> cells,
                  const View& view, const Add& add, std::vector<ViewPatch>& patches,
                  std::vector<CellKey>& patch_cells) {
  std::vector<Eigen::Vector3f> views;
  for (std::size_t i = 0; i < items.size();) {
    const CellKey cell = cells[items[i]];
    views.clear();
    std::size_t end = i;
    for (; end < items.size() && cells[items[end]] == cell; ++end)
      views.push_back(view(items[end]));
    const Eigen::Vector3f side = first_side(views);
    std::array<ViewPatch, 2> both;
    for (std::size_t k = i; k < end; ++k) {
      ViewPatch& patch = both[views[k - i].dot(side) < 0];
      patch.view += views[k - i];
      add(items[k], patch);
    }
    for (const ViewPatch& patch : both) {
      if (patch.moments[0] == 0) continue;
      patches.push_back(patch);
      patch_cells.push_back(cell);
    }
    i = end;
  }
}

/// Patches of all blocks, by make_patches.
template <class View, class Add>
PatchGrid make_grid(const Lattice& lattice, CellSort sorted, std::span<const CellKey> cells,
                    const View& view, const Add& add) {
  const std::size_t blocks = sorted.blocks.size();
  const std::size_t tasks = (blocks + blocks_per_task - 1) / blocks_per_task;
  std::vector<std::vector<ViewPatch>> patches(tasks);
  std::vector<std::vector<CellKey>> patch_cells(tasks);
  PatchGrid grid;
  grid.lattice = lattice;
  grid.begin.assign(blocks + 1, 0);
  parallel_for(blocks, blocks_per_task, [&](std::size_t begin, std::size_t end) {
    const std::size_t task = begin / blocks_per_task;
    for (std::size_t b = begin; b < end; ++b) {
      const auto items = std::span<const std::uint32_t>(sorted.order)
                             .subspan(sorted.begin[b], sorted.begin[b + 1] - sorted.begin[b]);
      make_patches(items, cells, view, add, patches[task], patch_cells[task]);
      grid.begin[b + 1] = std::uint32_t(patches[task].size());
    }
  });
  std::uint32_t total = 0;
  for (std::size_t task = 0; task < tasks; ++task) {
    for (std::size_t b = task * blocks_per_task; b < std::min(blocks, (task + 1) * blocks_per_task);
         ++b)
      grid.begin[b + 1] += total;
    total += std::uint32_t(patches[task].size());
  }
  grid.patches.reserve(total);
  grid.cells.reserve(total);
  for (std::size_t task = 0; task < tasks; ++task) {
    grid.patches.insert(grid.patches.end(), patches[task].begin(), patches[task].end());
    grid.cells.insert(grid.cells.end(), patch_cells[task].begin(), patch_cells[task].end());
  }
  grid.blocks = std::move(sorted.blocks);
  return grid;
}

/// Principal axes of points with these moments.
struct Shape {
  Eigen::Vector3d normal;
  Eigen::Vector3d centroid;
  Eigen::Vector3d variances;  ///< ascending
};

std::optional<Shape> shape_of(const std::array<double, 10>& m) {
  if (m[0] < 3) return std::nullopt;
  const Eigen::Vector3d mean = Eigen::Vector3d(m[1], m[2], m[3]) / m[0];
  Eigen::Matrix3d covariance;
  covariance << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
  covariance = covariance / m[0] - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return Shape{solver.eigenvectors().col(0), mean, solver.eigenvalues().cwiseMax(0)};
}

bool well_formed(const Shape& shape, double count, const NormalParams& params) {
  const Eigen::Array3d deviation = shape.variances.array().sqrt();
  return count >= params.min_points && deviation[1] > 0 &&
         deviation[1] >= params.min_width * deviation[2] &&
         deviation[0] <= params.max_thickness * deviation[1] && deviation[0] <= params.max_scatter;
}

/// Patches around one patch, itself among them.
using Neighbours = std::vector<std::uint32_t>;

/// Sums over those neighbours for which take(patch) holds; which ones they were is in `taken`.
template <class Take>
std::array<double, 10> sum_of(const PatchGrid& grid, const Neighbours& neighbours, const Take& take,
                              std::uint64_t& taken) {
  std::array<double, 10> sum{};
  taken = 0;
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const ViewPatch& patch = grid.patches[neighbours[k]];
    if (!take(patch)) continue;
    taken |= std::uint64_t{1} << k;
    add_moments(sum, patch.moments);
  }
  return sum;
}

/// Whether the scanners are behind a plane. Where those of the patch itself graze the plane, all
/// patches in the plane vote.
bool behind(const PatchGrid& grid, const ViewPatch& own, const Neighbours& neighbours,
            const Eigen::Vector3f& normal, const Shape& shape) {
  constexpr float grazing = 0.3f;  // sine of the angle between view and plane
  float ahead = normal.dot(own.view);
  if (std::abs(ahead) > grazing * float(own.moments[0])) return ahead < 0;
  const double farthest = most_deviations * std::sqrt(shape.variances[0] + least_variance);
  for (const std::uint32_t k : neighbours) {
    const auto& m = grid.patches[k].moments;
    const Eigen::Vector3d mean = Eigen::Vector3d(m[1], m[2], m[3]) / m[0];
    if (std::abs(shape.normal.dot(mean - shape.centroid)) <= farthest)
      ahead += normal.dot(grid.patches[k].view);
  }
  return ahead < 0;
}

PatchPlane plane_around(const PatchGrid& grid, std::uint32_t self, const Neighbours& neighbours,
                        const NormalParams& params) {
  const ViewPatch& own = grid.patches[self];
  // One scanner never sees both sides of a plane: what shares a scan with this patch is on its
  // side.
  std::uint64_t taken = 0, kept = 0;
  auto sum = sum_of(
      grid, neighbours, [&](const ViewPatch& p) { return (p.scans & own.scans) != 0; }, taken);
  if (sum[0] < params.min_points)
    sum = sum_of(
        grid, neighbours, [&](const ViewPatch& p) { return p.view.dot(own.view) > 0; }, taken);
  auto shape = shape_of(sum);
  if (!shape) return {};
  Eigen::Vector3f normal = shape->normal.cast<float>();
  if (behind(grid, own, neighbours, normal, *shape)) normal = -normal;
  // The scanners tell the other patches' side of that plane.
  sum = sum_of(
      grid, neighbours, [&](const ViewPatch& p) { return p.view.dot(normal) > 0; }, kept);
  if (kept != taken) shape = shape_of(sum);
  // Patches off the plane are of another surface: what is left without them has a sharp crease.
  for (int round = 0; shape && round < trimming_rounds; ++round) {
    const Eigen::Vector3d across = shape->normal;
    const double farthest = most_deviations * std::sqrt(shape->variances[0] + least_variance);
    taken = kept;
    sum = sum_of(
        grid, neighbours,
        [&](const ViewPatch& p) {
          const auto& m = p.moments;
          const Eigen::Vector3d mean = Eigen::Vector3d(m[1], m[2], m[3]) / m[0];
          return p.view.dot(normal) > 0 && std::abs(across.dot(mean - shape->centroid)) <= farthest;
        },
        kept);
    if (kept == taken) break;
    shape = shape_of(sum);
  }
  if (!shape || !well_formed(*shape, sum[0], params)) return {};
  PatchPlane plane;
  plane.normal = shape->normal.cast<float>();
  if (plane.normal.dot(normal) < 0) plane.normal = -plane.normal;
  plane.offset = float(plane.normal.cast<double>().dot(shape->centroid));
  const double variance = shape->variances[0] + least_variance;
  plane.variance = float(variance);
  plane.weight = float(sum[0] * shape->variances[1] / variance);
  return plane;
}

}  // namespace

PatchGrid view_patches(const Lattice& lattice, const CellSort& sorted,
                       std::span<const CellKey> cells, const Cloud& cloud,
                       std::span<const Eigen::Vector3d> scan_origins) {
  const auto scan_of = [&](std::uint32_t point) {
    return cloud.scan.empty() ? 0u : cloud.scan[point];
  };
  const auto view = [&](std::uint32_t i) -> Eigen::Vector3f {
    return (scan_origins[scan_of(i)] - cloud.points[i].cast<double>()).cast<float>().normalized();
  };
  const auto add = [&](std::uint32_t i, ViewPatch& patch) {
    add_point(patch, cloud.points[i].cast<double>() - lattice.origin);
    patch.scans |= std::uint64_t{1} << (scan_of(i) % 64);
  };
  return make_grid(lattice, sorted, cells, view, add);
}

PatchGrid coarser(const PatchGrid& fine) {
  std::vector<CellKey> cells(fine.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Eigen::Vector3i cell = cell_of(fine.cells[i]);
    cells[i] = cell_key(cell.x() >> 1, cell.y() >> 1, cell.z() >> 1);
  }
  const auto view = [&](std::uint32_t i) -> Eigen::Vector3f { return fine.patches[i].view; };
  const auto add = [&](std::uint32_t i, ViewPatch& patch) {
    add_moments(patch.moments, fine.patches[i].moments);
    patch.scans |= fine.patches[i].scans;
  };
  const Lattice lattice{.size = 2 * fine.lattice.size, .origin = fine.lattice.origin};
  return make_grid(lattice, sort_by_cell(cells), cells, view, add);
}

std::vector<PatchPlane> patch_planes(const PatchGrid& grid, const NormalParams& params) {
  std::vector<PatchPlane> planes(grid.patches.size());
  parallel_for(grid.blocks.size(), blocks_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> first;
    Neighbours neighbours;
    for (std::size_t b = begin; b < end; ++b) {
      const CellKey block = grid.blocks.key(b);
      surrounding_cells(grid.blocks, grid.begin, grid.cells, block, 1, first);
      for (std::uint32_t self = grid.begin[b]; self < grid.begin[b + 1]; ++self) {
        const Eigen::Vector3i at = cell_of(grid.cells[self]) - cell_of(block);
        neighbours.clear();
        for_patches_around(grid, first, at,
                           [&](std::uint32_t patch) { neighbours.push_back(patch); });
        planes[self] = plane_around(grid, self, neighbours, params);
      }
    }
  });
  return planes;
}

}  // namespace planum
