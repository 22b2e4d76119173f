#include "meshing/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshing/range_map.hpp"
#include "meshing/scan_indices.hpp"
#include "meshing/voxel_blocks.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t cells_per_task = 2048;

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
           const FreeSpaceParams& params) {
  const auto fail = [](const std::string& what) { throw Error("free space: " + what); };
  if (!(params.cell > 0)) fail("cell must be positive, is " + std::to_string(params.cell) + " m");
  if (!(params.margin >= 0))
    fail("margin must be at least 0, is " + std::to_string(params.margin) + " m");
  if (!(params.margin_per_metre >= 0))
    fail("margin_per_metre must be at least 0, is " + std::to_string(params.margin_per_metre));
  if (!(params.max_tilt > 0 && params.max_tilt <= pi / 2))
    fail("max_tilt must be between 0 and 90 degrees, is " +
         std::to_string(degrees(params.max_tilt)));
  if (params.min_scans < 0)
    fail("min_scans must be at least 0, is " + std::to_string(params.min_scans));
  check_scan_indices(cloud, origins.size(), "free space");
  if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size())
    fail(std::to_string(cloud.points.size()) + " points, but " +
         std::to_string(cloud.normals.size()) + " normals");
}

/// The points of a cell, judged together.
struct CellPoints {
  std::uint32_t begin = 0, end = 0;  ///< in the order of the cells
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< mean, unit; zero where there is none
  int scans = 0;                                     ///< that have a point in it
  int through = 0;                                   ///< that look through it
};

std::vector<CellPoints> cells_of(const Cloud& cloud, std::span<const CellKey> keys,
                                 std::span<const std::uint32_t> order) {
  std::vector<CellPoints> cells;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (i == 0 || keys[order[i]] != keys[order[i - 1]]) cells.push_back({.begin = i});
    cells.back().end = i + 1;
  }
  parallel_for(cells.size(), cells_per_task, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> scans;
    for (std::size_t k = begin; k < end; ++k) {
      CellPoints& cell = cells[k];
      scans.clear();
      for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
        cell.mean += cloud.points[order[i]];
        if (!cloud.normals.empty()) cell.normal += cloud.normals[order[i]];
        scans.push_back(cloud.scan[order[i]]);
      }
      cell.mean /= static_cast<float>(cell.end - cell.begin);
      if (!cell.normal.isZero(0)) cell.normal.normalize();
      std::sort(scans.begin(), scans.end());
      cell.scans = static_cast<int>(std::unique(scans.begin(), scans.end()) - scans.begin());
    }
  });
  return cells;
}

}  // namespace

std::vector<std::uint8_t> in_free_space(const Cloud& cloud,
                                        std::span<const Eigen::Vector3d> origins,
                                        const FreeSpaceParams& params) {
  check(cloud, origins, params);
  std::vector<std::uint8_t> result(cloud.points.size(), 0);
  if (params.min_scans == 0 || cloud.scan.empty()) return result;
  const Lattice lattice = lattice_around(cloud.points, params.cell);
  const std::vector<CellKey> keys = cell_keys(lattice, cloud.points);
  const CellSort sorted = sort_by_cell(keys);
  std::vector<CellPoints> cells = cells_of(cloud, keys, sorted.order);
  const SightParams sight{.margin = params.margin,
                          .margin_per_metre = params.margin_per_metre,
                          .max_tilt = params.max_tilt};
  visit_range_maps(cloud, origins, [&](std::span<const RangeMap> maps) {
    parallel_for(cells.size(), cells_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (const RangeMap& map : maps)
          cells[k].through += map.looks_through(cells[k].mean, cells[k].normal, sight);
    });
  });
  for (const CellPoints& cell : cells) {
    if (cell.through < std::max(params.min_scans, 2 * cell.scans)) continue;
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) result[sorted.order[i]] = 1;
  }
  return result;
}

std::size_t drop_normals_in_free_space(Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                                       const FreeSpaceParams& params) {
  if (cloud.normals.size() != cloud.points.size())
    throw Error("free space: " + std::to_string(cloud.points.size()) + " points, but " +
                std::to_string(cloud.normals.size()) + " normals");
  const std::vector<std::uint8_t> free = in_free_space(cloud, scan_origins, params);
  std::size_t count = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (!free[i]) continue;
    cloud.normals[i].setZero();
    ++count;
  }
  return count;
}

}  // namespace planum
