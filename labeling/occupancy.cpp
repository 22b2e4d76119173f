#include "labeling/occupancy.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "meshing/scan_indices.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"

namespace planum {
namespace {

constexpr std::size_t points_per_block = 1 << 13, triangles_per_block = 1 << 12;
constexpr double most_cells = 1 << 26;

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
           const OccupancyParams& params) {
  const auto fail = [](const std::string& what) { throw Error("occupancy: " + what); };
  if (!(params.cell > 0)) fail("cell must be positive, is " + std::to_string(params.cell) + " m");
  if (!(params.high > params.low))
    fail("the robot's heights are from " + std::to_string(params.low) + " to " +
         std::to_string(params.high) + " m");
  if (params.max_rays == 0) fail("max_rays must be above 0");
  if (cloud.normals.size() != cloud.points.size()) fail("the cloud has no normals");
  if (cloud.points.empty()) return;
  if (origins.empty()) fail("there are no scan origins");
  check_scan_indices(cloud, origins.size(), "occupancy");
}

/// Around all surface, with a cell to spare; cells at multiples of their size in the world.
FloorGrid grid_around(const Cloud& cloud, double cell) {
  Eigen::Array2d low = Eigen::Array2d::Constant(HUGE_VAL), high = -low;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (cloud.normals[i].isZero()) continue;
    const Eigen::Array2d p = cloud.points[i].head<2>().cast<double>().array();
    low = low.min(p);
    high = high.max(p);
  }
  FloorGrid grid;
  grid.cell = cell;
  if (!(low <= high).all()) return grid;
  const Eigen::Array2d size = high - low;
  grid.cell = std::max(cell, std::sqrt(size.prod() / most_cells));
  const Eigen::Array2d first = (low / grid.cell).floor() - 1, last = (high / grid.cell).floor() + 2;
  grid.plan_from_world =
      Pose(Eigen::Translation3d(-first.x() * grid.cell, -first.y() * grid.cell, 0));
  grid.columns = static_cast<int>(last.x() - first.x());
  grid.rows = static_cast<int>(last.y() - first.y());
  return grid;
}

/// Counts of what happened in the cells.
class Evidence {
 public:
  Evidence(const FloorGrid& grid, double floor, const OccupancyParams& params)
      : grid_(grid),
        low_(floor + params.low),
        high_(floor + params.high),
        params_(params),
        hits_(grid.size(), 0),
        passes_(grid.size(), 0),
        floor_passes_(grid.size(), 0),
        has_surface_(grid.size(), 0) {}

  void add_hit(const Eigen::Vector3d& end) {
    if (end.z() < low_ || end.z() > high_) return;
    const std::ptrdiff_t cell = grid_.find(end.head<2>());
    if (cell >= 0) count(hits_[static_cast<std::size_t>(cell)]);
  }

  /// What a triangle covers at the robot's heights, in steps of half a cell.
  void add_surface(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    if (std::min({a.z(), b.z(), c.z()}) > high_ || std::max({a.z(), b.z(), c.z()}) < low_) return;
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int steps = static_cast<int>(std::ceil(2 * longest / grid_.cell)) + 1;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const Eigen::Vector3d p = a + double(i) / steps * (b - a) + double(j) / steps * (c - a);
        const std::ptrdiff_t cell = grid_.find(p.head<2>());
        if (p.z() >= low_ && p.z() <= high_ && cell >= 0)
          std::atomic_ref(has_surface_[static_cast<std::size_t>(cell)])
              .store(1, std::memory_order_relaxed);
      }
  }

  /// The parts of a ray at the robot's heights, and near the floor.
  void add_ray(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    count_between(from, to, low_, high_, passes_);
    count_between(from, to, low_ - floor_depth, low_ + params_.free_height, floor_passes_);
  }

  Occupancy at(std::size_t cell, double rays_per_pass) const {
    if (has_surface_[cell]) return Occupancy::occupied;
    const double hits = hits_[cell], passes = rays_per_pass * passes_[cell];
    if (hits >= params_.min_hits && hits >= params_.min_hit_share * (hits + passes))
      return Occupancy::occupied;
    return floor_passes_[cell] > 0 ? Occupancy::free : Occupancy::unknown;
  }

 private:
  static constexpr double floor_depth = 0.25;  // m under the lowest height of the robot

  void count_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double low,
                     double high, std::vector<std::uint32_t>& counters) const {
    const Eigen::Vector3d way = to - from;
    const double length = way.norm();
    double begin = 0, end = 1;
    if (to.z() > low_) end -= params_.end_margin / length;  // it ends at a thing, not at the floor
    const auto clip = [&](double height, double side) {
      const double a = side * (from.z() - height), b = side * (to.z() - height);
      if (a > 0 && b > 0) end = -1;
      if ((a > 0) == (b > 0)) return;
      (a > 0 ? begin : end) = a > 0 ? std::max(begin, a / (a - b)) : std::min(end, a / (a - b));
    };
    clip(high, 1);
    clip(low, -1);
    if (!(begin < end)) return;
    const Eigen::Vector3d a = from + begin * way, b = from + end * way;
    for_each_cell_between(grid_, a.head<2>(), b.head<2>(),
                          [&](std::size_t cell) { count(counters[cell]); });
  }

  static void count(std::uint32_t& counter) {
    std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
  }

  const FloorGrid& grid_;
  double low_, high_;
  const OccupancyParams& params_;
  std::vector<std::uint32_t> hits_, passes_, floor_passes_;
  CellMask has_surface_;
};

}  // namespace

OccupancyGrid occupancy_grid(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
                             const TriangleMesh& mesh, double floor,
                             const OccupancyParams& params) {
  check(cloud, origins, params);
  OccupancyGrid result{.grid = grid_around(cloud, params.cell), .floor = floor, .cells = {}};
  if (result.grid.size() == 0) return result;
  Evidence evidence(result.grid, floor, params);
  const Eigen::Vector3d shift = result.grid.plan_from_world.translation();
  const std::size_t step = (cloud.points.size() + params.max_rays - 1) / params.max_rays;
  parallel_for(cloud.points.size(), points_per_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (cloud.normals[i].isZero()) continue;
      const Eigen::Vector3d point = cloud.points[i].cast<double>() + shift;
      evidence.add_hit(point);
      if (i % step == 0)
        evidence.add_ray(origins[cloud.scan.empty() ? 0 : cloud.scan[i]] + shift, point);
    }
  });
  parallel_for(mesh.triangles.size(), triangles_per_block, [&](std::size_t begin, std::size_t end) {
    const auto corner = [&](std::uint32_t v) {
      return Eigen::Vector3d(mesh.vertices[v].cast<double>() + shift);
    };
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [a, b, c] = mesh.triangles[i];
      evidence.add_surface(corner(a), corner(b), corner(c));
    }
  });
  result.cells.resize(result.grid.size());
  for (std::size_t k = 0; k < result.cells.size(); ++k)
    result.cells[k] = evidence.at(k, static_cast<double>(step));
  return result;
}

std::vector<double> storey_floors(const PolygonMap& map, const Labels& labels, double min_storey,
                                  double min_area) {
  if (labels.polygons.size() != map.polygons.size())
    throw Error("storeys: " + std::to_string(map.polygons.size()) + " polygons with " +
                std::to_string(labels.polygons.size()) + " labels");
  struct Level {
    double height, area;
  };
  std::vector<Level> levels;
  for (std::size_t i = 0; i < map.polygons.size(); ++i) {
    if (labels.polygons[i].label != Label::floor) continue;
    double height = 0;
    for (const std::uint32_t v : map.polygons[i].outer) height += map.vertices[v].z();
    levels.push_back(
        {height / static_cast<double>(map.polygons[i].outer.size()), map.polygons[i].area});
  }
  // The largest floor makes a storey and takes what is near it, and so on.
  std::stable_sort(levels.begin(), levels.end(),
                   [](const Level& a, const Level& b) { return a.area > b.area; });
  std::vector<Level> storeys;
  for (const Level& level : levels) {
    const auto near = std::find_if(storeys.begin(), storeys.end(), [&](const Level& storey) {
      return std::abs(storey.height - level.height) < min_storey;
    });
    if (near == storeys.end())
      storeys.push_back(level);
    else
      near->area += level.area;
  }
  std::vector<double> floors;
  for (const Level& storey : storeys)
    if (storey.area >= min_area) floors.push_back(storey.height);
  std::sort(floors.begin(), floors.end());
  return floors;
}

}  // namespace planum
