#include "labeling/rooms/storeys.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "meshing/scan_indices.hpp"

namespace planum {
namespace {

constexpr double below_floor = 0.3;  // m, what is so little below a floor belongs to its storey
constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// What was scanned in a storey, from within it.
struct StoreyScans {
  Cloud cloud;
  std::vector<Eigen::Vector3d> origins;
  std::vector<std::size_t> scans;  ///< for each origin its scan of the building
};

StoreyScans scans_between(const Cloud& cloud, std::span<const Eigen::Vector3d> origins, double low,
                          double high) {
  const auto is_inside = [&](double z) { return z >= low && z < high; };
  StoreyScans storey;
  std::vector<std::size_t> number(origins.size(), none);
  for (std::size_t s = 0; s < origins.size(); ++s) {
    if (!is_inside(origins[s].z())) continue;
    number[s] = storey.origins.size();
    storey.origins.push_back(origins[s]);
    storey.scans.push_back(s);
  }
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const std::size_t scan = number[cloud.scan[i]];
    if (scan == none || !is_inside(double{cloud.points[i].z()})) continue;
    storey.cloud.points.push_back(cloud.points[i]);
    storey.cloud.normals.push_back(cloud.normals[i]);
    storey.cloud.scan.push_back(static_cast<std::uint32_t>(scan));
  }
  return storey;
}

/// Adds the rooms of a storey to those of the building.
void append(RoomMap& building, RoomMap rooms, std::size_t storey,
            const std::vector<std::size_t>& scans) {
  const std::size_t first = building.rooms.size();
  for (Room& room : rooms.rooms) {
    room.storey = storey;
    for (std::size_t& s : room.scans) s = scans[s];
    building.rooms.push_back(std::move(room));
  }
  for (Opening& opening : rooms.openings) {
    for (std::size_t& room : opening.rooms) room += first;
    building.openings.push_back(std::move(opening));
  }
  for (std::size_t i = 0; i < rooms.room_of_polygon.size(); ++i)
    if (rooms.room_of_polygon[i] >= 0 && building.room_of_polygon[i] < 0)
      building.room_of_polygon[i] = rooms.room_of_polygon[i] + static_cast<std::int32_t>(first);
}

/// Visited rooms in the order of their first scan, then the others as they are.
RoomMap in_order(RoomMap building) {
  std::vector<std::size_t> order(building.rooms.size()), place(order.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto first_scan = [&](std::size_t room) {
    const auto& scans = building.rooms[room].scans;
    return scans.empty() ? none : scans.front();
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return first_scan(a) < first_scan(b); });
  std::vector<Room> rooms;
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = k;
    rooms.push_back(std::move(building.rooms[order[k]]));
    rooms.back().name = fmt::format("room {}", k + 1);
  }
  building.rooms = std::move(rooms);
  for (Opening& opening : building.openings) {
    for (std::size_t& room : opening.rooms) room = place[room];
    if (opening.rooms.size() == 2 && opening.rooms[0] > opening.rooms[1]) {
      std::swap(opening.rooms[0], opening.rooms[1]);
      opening.across = -opening.across;
    }
  }
  std::stable_sort(building.openings.begin(), building.openings.end(),
                   [](const Opening& a, const Opening& b) { return a.rooms < b.rooms; });
  for (std::int32_t& room : building.room_of_polygon)
    if (room >= 0) room = static_cast<std::int32_t>(place[static_cast<std::size_t>(room)]);
  return building;
}

}  // namespace

RoomMap find_rooms_of_storeys(const Cloud& cloud, std::span<const Eigen::Vector3d> scan_origins,
                              const PolygonMap& map, std::span<const double> floors,
                              const RoomParams& params) {
  if (floors.size() < 2 || cloud.scan.size() != cloud.points.size()) {
    RoomMap rooms = find_rooms(cloud, scan_origins, map, params);
    rooms.storeys.assign(floors.begin(), floors.end());
    return rooms;
  }
  check_scan_indices(cloud, scan_origins.size(), "rooms");
  RoomMap building;
  building.storeys.assign(floors.begin(), floors.end());
  building.room_of_polygon.assign(map.polygons.size(), -1);
  for (std::size_t k = 0; k < floors.size(); ++k) {
    const double low = k == 0 ? -HUGE_VAL : floors[k] - below_floor;
    const double high = k + 1 == floors.size() ? HUGE_VAL : floors[k + 1] - below_floor;
    const StoreyScans storey = scans_between(cloud, scan_origins, low, high);
    if (storey.origins.empty()) continue;
    append(building, find_rooms(storey.cloud, storey.origins, map, params), k, storey.scans);
  }
  return in_order(std::move(building));
}

}  // namespace planum
