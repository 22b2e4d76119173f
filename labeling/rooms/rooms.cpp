#include "labeling/rooms/rooms.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "labeling/plan/grid_morphology.hpp"
#include "labeling/rooms/polygon_rooms.hpp"
#include "labeling/rooms/room_shape.hpp"
#include "slam/core/error.hpp"

namespace planum {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

void check(const Cloud& cloud, std::span<const Eigen::Vector3d> origins, const RoomParams& params) {
  if (cloud.normals.size() != cloud.points.size() || cloud.scan.size() != cloud.points.size())
    throw Error("rooms: the cloud needs a normal and a scan index for each point");
  for (const std::uint32_t s : cloud.scan)
    if (s >= origins.size())
      throw Error(
          fmt::format("rooms: a point is from scan {}, but there are {} scans", s, origins.size()));
  if (!(params.cell >= 0.01 && params.cell <= 0.2))
    throw Error(fmt::format("rooms: cell is {} m, must be 0.01 to 0.2", params.cell));
}

/// All that is known about the plan before rooms have names.
struct Plan {
  FloorGrid grid;
  std::vector<Eigen::Vector3d> origins;
  LevelSurface floor, ceiling;
  bool has_ceiling = false;
  std::vector<WallFace> faces;
  CellMask free, wall;
  FaceSamples samples;
  RoomRegions regions;
  std::vector<RegionFace> region_faces;
  std::vector<RoomShape> shapes;
  OpeningSet openings;
};

/// Where no ceiling was scanned, the height most walls end at stands in for it.
void assume_ceiling(const Cloud& plan, const FloorGrid& grid, LevelSurface& ceiling) {
  constexpr double bin = 0.1;
  std::vector<float> top(grid.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < plan.points.size(); ++i) {
    if (std::abs(plan.normals[i].z()) > 0.3f) continue;
    const std::ptrdiff_t cell = grid.find(plan.points[i].head<2>().cast<double>());
    if (cell < 0) continue;
    float& height = top[static_cast<std::size_t>(cell)];
    if (std::isnan(height) || plan.points[i].z() > height) height = plan.points[i].z();
  }
  std::map<int, std::size_t> histogram;
  for (const float height : top)
    if (!std::isnan(height)) ++histogram[static_cast<int>(std::floor(double{height} / bin))];
  const auto fullest =
      std::max_element(histogram.begin(), histogram.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (fullest == histogram.end()) return;
  std::fill(ceiling.nearest.begin(), ceiling.nearest.end(),
            static_cast<float>((fullest->first + 1) * bin));
}

/// Cells that belong to a room if no wall parts them: below a ceiling, or crossed by a ray near
/// one.
CellMask seen_space(const Plan& plan, double ceiling_reach) {
  const FloorGrid& grid = plan.grid;
  CellMask below(grid.size(), 0);
  for (std::size_t i = 0; i < grid.size(); ++i)
    below[i] = !std::isnan(plan.has_ceiling ? plan.ceiling.height[i] : plan.floor.height[i]);
  const CellMask near = dilated(below, grid.columns, grid.rows, ceiling_reach / grid.cell);
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (plan.free[i] && near[i]) below[i] = 1;
  return below;
}

/// Regions that only a beam parts become one; the cells below the beam become its own.
void join_regions(Plan& plan) {
  constexpr double beam_width = 0.7;  // m
  const FloorGrid& grid = plan.grid;
  std::vector<std::size_t> root(plan.regions.count);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t r) {
    while (root[r] != r) r = root[r];
    return r;
  };
  for (const auto& [a, b] : plan.openings.joined_regions) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    root[high] = low;
  }
  for (std::int32_t& r : plan.regions.of_cell)
    if (r >= 0) r = static_cast<std::int32_t>(find(static_cast<std::size_t>(r)));
  for (std::size_t r = 0; r < root.size(); ++r) {
    const bool grew =
        std::any_of(plan.openings.joined_regions.begin(), plan.openings.joined_regions.end(),
                    [&](const auto& pair) { return find(pair.first) == r; });
    if (root[r] != r || !grew) continue;
    CellMask mask(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i)
      mask[i] = plan.regions.of_cell[i] == static_cast<std::int32_t>(r);
    mask = closed(mask, grid.columns, grid.rows, 0.5 * beam_width / grid.cell);
    for (std::size_t i = 0; i < grid.size(); ++i)
      if (mask[i] && plan.regions.of_cell[i] < 0 && plan.free[i])
        plan.regions.of_cell[i] = static_cast<std::int32_t>(r);
  }
  for (Opening& opening : plan.openings.openings)
    for (std::size_t& r : opening.rooms) r = find(r);
}

/// Faces just below the ceiling, and lower ones where the upper part of a wall was not seen.
std::vector<WallFace> find_walls(const Cloud& points, const Plan& plan, const RoomParams& params) {
  std::vector<WallFace> faces =
      find_wall_faces(points_below_ceiling(points, plan.grid, plan.ceiling, params.wall_points),
                      plan.grid, params.walls);
  if (!plan.has_ceiling) return faces;
  const std::vector<WallPoint> lower =
      points_lower_down(points, plan.grid, plan.floor, plan.ceiling, faces, params.wall_points);
  for (const WallFace& face : find_wall_faces(lower, plan.grid, params.walls))
    if (is_wall(face, lower, plan.grid, plan.floor, plan.free, params.wall_points))
      faces.push_back(face);
  const CellMask lintels =
      lintel_cells(points, plan.grid, plan.floor, plan.ceiling, params.wall_gaps);
  return with_door_gaps_closed(std::move(faces), plan.grid, plan.ceiling, lintels, plan.free,
                               params.wall_gaps);
}

Plan make_plan(const Cloud& cloud, std::span<const Eigen::Vector3d> origins,
               const RoomParams& params) {
  Plan plan;
  plan.grid = make_floor_grid(cloud, params.cell);
  if (plan.grid.size() == 0) return plan;
  const FloorGrid& grid = plan.grid;
  const Cloud points = transformed(cloud, grid.plan_from_world);
  for (const Eigen::Vector3d& origin : origins)
    plan.origins.push_back(grid.plan_from_world * origin);
  plan.floor = find_level_surface(points, grid, LevelSide::floor, nullptr, 0, params.levels);
  plan.ceiling = find_level_surface(points, grid, LevelSide::ceiling, &plan.floor,
                                    params.min_clearance, params.levels);
  const auto known = [](const std::vector<float>& heights) {
    return std::count_if(heights.begin(), heights.end(), [](float h) { return !std::isnan(h); });
  };
  plan.has_ceiling = 10 * known(plan.ceiling.height) > known(plan.floor.height);
  if (!plan.has_ceiling) assume_ceiling(points, grid, plan.ceiling);
  plan.free = free_cells(points, plan.origins, grid, params.rays);
  plan.faces = find_walls(points, plan, params);
  plan.wall = wall_cells(grid, plan.faces);
  plan.samples = sample_faces(points, plan.origins, grid, plan.faces, params.rays);
  plan.regions =
      split_into_regions(grid, seen_space(plan, params.ceiling_reach), plan.wall, params.regions);
  plan.region_faces = faces_of_regions(grid, plan.regions, plan.faces);
  const std::vector<FaceOpening> holes =
      find_face_openings(plan.faces, plan.samples, grid, plan.floor, plan.ceiling, params.search);
  plan.openings = find_openings(points, grid, plan.faces, plan.region_faces, plan.samples, holes,
                                plan.regions, params.openings);
  if (!plan.openings.joined_regions.empty()) {
    join_regions(plan);
    plan.region_faces = faces_of_regions(grid, plan.regions, plan.faces);
  }
  for (std::size_t r = 0; r < plan.regions.count; ++r) {
    std::vector<RegionFace> own;
    for (const RegionFace& f : plan.region_faces)
      if (f.region == r) own.push_back(f);
    plan.shapes.push_back(
        measure_room(grid, plan.regions, r, own, plan.faces, plan.wall, plan.floor, plan.ceiling));
  }
  return plan;
}

/// The scans taken in each region.
std::vector<std::vector<std::size_t>> scans_of_regions(const Plan& plan) {
  std::vector<std::vector<std::size_t>> scans(plan.regions.count);
  for (std::size_t s = 0; s < plan.origins.size(); ++s) {
    const std::ptrdiff_t cell = plan.grid.find(plan.origins[s].head<2>());
    if (cell < 0) continue;
    const std::int32_t region = plan.regions.of_cell[static_cast<std::size_t>(cell)];
    if (region >= 0) scans[static_cast<std::size_t>(region)].push_back(s);
  }
  return scans;
}

/// Regions that are rooms, in the order of their names: visited ones in the order of their first
/// scan, then those seen through doors, the largest first.
std::vector<std::size_t> rooms_in_order(const Plan& plan,
                                        const std::vector<std::vector<std::size_t>>& scans,
                                        const RoomParams& params) {
  const auto seen = [&](std::size_t r, double share) {
    return plan.shapes[r].floor_share >= share &&
           (!plan.has_ceiling || plan.shapes[r].ceiling_share >= share);
  };
  std::vector<std::uint8_t> is_room(plan.regions.count, 0);
  for (std::size_t r = 0; r < is_room.size(); ++r)
    is_room[r] = !scans[r].empty() && seen(r, params.min_seen);
  // What is seen through a window is outside, even where it has a floor and a ceiling.
  for (bool grows = true; grows;) {
    grows = false;
    for (const Opening& opening : plan.openings.openings) {
      if (opening.kind == OpeningKind::window || opening.rooms.size() < 2) continue;
      if (!is_room[opening.rooms[0]] && !is_room[opening.rooms[1]]) continue;
      for (const std::size_t r : opening.rooms)
        if (!is_room[r] && seen(r, params.min_seen_unvisited)) {
          is_room[r] = 1;
          grows = true;
        }
    }
  }
  std::vector<std::size_t> order;
  for (std::size_t r = 0; r < is_room.size(); ++r)
    if (is_room[r]) order.push_back(r);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const std::size_t first_a = scans[a].empty() ? none : scans[a].front();
    const std::size_t first_b = scans[b].empty() ? none : scans[b].front();
    return first_a != first_b ? first_a < first_b : plan.shapes[a].area > plan.shapes[b].area;
  });
  return order;
}

Room described(const RoomShape& shape, std::size_t number, const Pose& world_from_plan) {
  Room room;
  room.name = fmt::format("room {}", number);
  room.centre = world_from_plan * Eigen::Vector3d(shape.centre.x(), shape.centre.y(),
                                                  0.5 * (shape.floor + shape.ceiling));
  room.along = world_from_plan.linear() * Eigen::Vector3d(shape.along.x(), shape.along.y(), 0);
  room.area = shape.area;
  room.width = shape.width;
  room.depth = shape.depth;
  room.height = shape.ceiling - shape.floor;
  for (const Eigen::Vector2d& p : shape.outline.outer)
    room.outline.push_back(world_from_plan * Eigen::Vector3d(p.x(), p.y(), shape.floor));
  return room;
}

/// Openings in the world with rooms instead of regions; those between no rooms are left out.
std::vector<Opening> openings_of_rooms(const Plan& plan,
                                       const std::vector<std::int32_t>& room_of_region,
                                       const Pose& world_from_plan) {
  std::vector<Opening> result;
  for (Opening opening : plan.openings.openings) {
    std::vector<std::size_t> rooms;
    for (const std::size_t region : opening.rooms)
      if (const std::int32_t room = room_of_region[region]; room >= 0)
        rooms.push_back(static_cast<std::size_t>(room));
    if (rooms.empty()) continue;
    if (rooms.size() == 2 && rooms[0] > rooms[1]) {
      std::swap(rooms[0], rooms[1]);
      opening.across = -opening.across;
    }
    rooms.erase(std::unique(rooms.begin(), rooms.end()), rooms.end());
    opening.rooms = std::move(rooms);
    opening.position = world_from_plan * opening.position;
    opening.across = world_from_plan.linear() * opening.across;
    result.push_back(std::move(opening));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Opening& a, const Opening& b) { return a.rooms < b.rooms; });
  return result;
}

}  // namespace

RoomMap find_rooms(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                   const PolygonMap& map, const RoomParams& params) {
  check(cloud, scan_origins, params);
  RoomMap result;
  result.room_of_polygon.assign(map.polygons.size(), -1);
  const Plan plan = make_plan(cloud, scan_origins, params);
  if (plan.shapes.empty()) return result;
  const Pose world_from_plan = plan.grid.plan_from_world.inverse();
  const std::vector<std::vector<std::size_t>> scans = scans_of_regions(plan);
  const std::vector<std::size_t> order = rooms_in_order(plan, scans, params);
  std::vector<std::int32_t> room_of_region(plan.regions.count, -1);
  std::vector<RegionLevels> levels;
  for (const RoomShape& shape : plan.shapes) levels.push_back({shape.floor, shape.ceiling});
  for (std::size_t k = 0; k < order.size(); ++k) {
    room_of_region[order[k]] = static_cast<std::int32_t>(k);
    result.rooms.push_back(described(plan.shapes[order[k]], k + 1, world_from_plan));
    result.rooms.back().scans = scans[order[k]];
  }
  result.openings = openings_of_rooms(plan, room_of_region, world_from_plan);
  const auto regions = regions_of_polygons(map, plan.grid, plan.regions, levels);
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (regions[i] >= 0)
      result.room_of_polygon[i] = room_of_region[static_cast<std::size_t>(regions[i])];
  return result;
}

}  // namespace planum
