#include "meshing/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "meshing/scan_indices.hpp"
#include "meshing/voxel_blocks.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float unseen = 0;

/// Pixels of a face of the finest map, about 0.7 degrees each; coarser ones have half as many.
constexpr int most_pixels = 128, least_pixels = 32;
/// Of the nine pixels around a direction so many must have returns.
constexpr int least_returns = 5;
/// A map is fine enough if the nine pixels around a return have so many on average.
constexpr double usual_returns = 6;
/// Maps that are held at a time.
constexpr std::size_t maps_at_once = 32;
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

/// A direction on one of the six faces of a cube around the scanner, row by row.
struct Pixel {
  int face, row, column;
};

Pixel pixel_of(const Eigen::Vector3f& direction, int pixels) {
  int axis = 0;
  const Eigen::Vector3f size = direction.cwiseAbs();
  size.maxCoeff(&axis);
  const float scale = 0.5f * static_cast<float>(pixels) / size[axis];
  const auto place = [&](float along) {
    const int at = static_cast<int>(along * scale + 0.5f * static_cast<float>(pixels));
    return std::clamp(at, 0, pixels - 1);
  };
  return {2 * axis + (direction[axis] > 0), place(direction[(axis + 1) % 3]),
          place(direction[(axis + 2) % 3])};
}

/// How far a scan sees at least about each direction (m); `unseen` where it has too few returns.
class RangeMap {
 public:
  RangeMap() = default;
  RangeMap(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own,
           const Eigen::Vector3d& origin)
      : origin_(origin.cast<float>()) {
    for (pixels_ = most_pixels;; pixels_ /= 2) {
      fill(points, own);
      if (widened() >= usual_returns || pixels_ == least_pixels) return;
    }
  }

  /// Whether the rays about a place all end behind it by more than the margin. `normal` may be
  /// zero.
  bool looks_through(const Eigen::Vector3f& place, const Eigen::Vector3f& normal,
                     const FreeSpaceParams& params) const {
    const Eigen::Vector3f way = place - origin_;
    const float squared = way.squaredNorm();
    if (squared >= farthest_ * farthest_ || squared == 0) return false;
    const float free = ranges_[at(pixel_of(way, pixels_))], range = std::sqrt(squared);
    const float margin = static_cast<float>(params.margin + params.margin_per_metre * range);
    if (free == unseen || free <= range + margin) return false;
    return normal.isZero(0) ||
           std::abs(normal.dot(way)) >= static_cast<float>(std::cos(params.max_tilt)) * range;
  }

 private:
  std::size_t at(const Pixel& p) const {
    return static_cast<std::size_t>((p.face * pixels_ + p.row) * pixels_ + p.column);
  }

  /// The nearest return of each pixel.
  void fill(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> own) {
    ranges_.assign(static_cast<std::size_t>(6 * pixels_ * pixels_), infinite);
    farthest_ = 0;
    for (const std::uint32_t i : own) {
      const Eigen::Vector3f way = points[i] - origin_;
      const float range = way.norm();
      if (!(range > 0)) continue;
      float& nearest = ranges_[at(pixel_of(way, pixels_))];
      nearest = std::min(nearest, range);
      farthest_ = std::max(farthest_, range);
    }
  }

  /// Gives each pixel the nearest return of the nine around it; at the rims of faces, where not all
  /// nine are at hand, nothing is known. Returns how many returns these have on average.
  double widened() {
    std::vector<float> wide(ranges_.size(), unseen);
    std::size_t returns = 0, centres = 0;
    for (int face = 0; face < 6; ++face)
      for (int row = 1; row + 1 < pixels_; ++row)
        for (int column = 1; column + 1 < pixels_; ++column) {
          float nearest = infinite;
          int count = 0;
          for (int r = row - 1; r <= row + 1; ++r)
            for (int c = column - 1; c <= column + 1; ++c) {
              const float range = ranges_[at({face, r, c})];
              nearest = std::min(nearest, range);
              count += range < infinite;
            }
          const std::size_t here = at({face, row, column});
          if (count >= least_returns) wide[here] = nearest;
          if (ranges_[here] == infinite) continue;
          returns += static_cast<std::size_t>(count);
          ++centres;
        }
    ranges_.swap(wide);
    return centres == 0 ? 0 : static_cast<double>(returns) / static_cast<double>(centres);
  }

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  int pixels_ = most_pixels;
  float farthest_ = 0;
  std::vector<float> ranges_;
};

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

std::vector<std::vector<std::uint32_t>> points_of_scans(const Cloud& cloud, std::size_t scans) {
  std::vector<std::vector<std::uint32_t>> result(scans);
  for (std::uint32_t i = 0; i < cloud.scan.size(); ++i) result[cloud.scan[i]].push_back(i);
  return result;
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
  const auto own = points_of_scans(cloud, origins.size());
  for (std::size_t first = 0; first < origins.size(); first += maps_at_once) {
    std::vector<RangeMap> maps(std::min(maps_at_once, origins.size() - first));
    parallel_for(maps.size(), 1, [&](std::size_t k, std::size_t) {
      maps[k] = RangeMap(cloud.points, own[first + k], origins[first + k]);
    });
    parallel_for(cells.size(), cells_per_task, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k)
        for (const RangeMap& map : maps)
          cells[k].through += map.looks_through(cells[k].mean, cells[k].normal, params);
    });
  }
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
