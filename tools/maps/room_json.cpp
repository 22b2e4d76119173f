#include "tools/maps/room_json.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

/// Tenths of millimetres: more would be noise to a reader.
double rounded(double metres) { return std::round(metres * 1e4) / 1e4; }

Json point_json(const Eigen::Vector3d& p) {
  return Json::array({rounded(p.x()), rounded(p.y()), rounded(p.z())});
}

double perimeter(const std::vector<Eigen::Vector3d>& outline) {
  double length = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    length += (outline[(i + 1) % outline.size()] - outline[i]).norm();
  return length;
}

/// Names of the rooms one can go to, in their order.
Json neighbours_json(const RoomMap& rooms, std::size_t room) {
  std::set<std::size_t> others;
  for (const Opening& opening : rooms.openings)
    if (opening.kind != OpeningKind::window &&
        std::find(opening.rooms.begin(), opening.rooms.end(), room) != opening.rooms.end())
      others.insert(opening.rooms.begin(), opening.rooms.end());
  others.erase(room);
  Json names = Json::array();
  for (const std::size_t other : others) names.push_back(rooms.rooms[other].name);
  return names;
}

}  // namespace

Json rooms_json(const RoomMap& rooms) {
  Json list = Json::array();
  for (std::size_t i = 0; i < rooms.rooms.size(); ++i) {
    const Room& room = rooms.rooms[i];
    Json outline = Json::array();
    for (const Eigen::Vector3d& p : room.outline) outline.push_back(point_json(p));
    list.push_back({{"name", room.name},
                    {"storey", room.storey + 1},
                    {"centre", point_json(room.centre)},
                    {"area_m2", rounded(room.area)},
                    {"perimeter_m", rounded(perimeter(room.outline))},
                    {"width_m", rounded(room.width)},
                    {"depth_m", rounded(room.depth)},
                    {"height_m", rounded(room.height)},
                    {"depth_direction", point_json(room.along)},
                    {"neighbours", neighbours_json(rooms, i)},
                    {"outline", std::move(outline)}});
  }
  return list;
}

Json openings_json(const RoomMap& rooms) {
  Json list = Json::array();
  for (const Opening& opening : rooms.openings) {
    Json joined = Json::array();
    for (const std::size_t room : opening.rooms) joined.push_back(rooms.rooms[room].name);
    list.push_back({{"kind", name(opening.kind)},
                    {"position", point_json(opening.position)},
                    {"across", point_json(opening.across)},
                    {"width_m", rounded(opening.width)},
                    {"height_m", rounded(opening.height)},
                    {"sill_m", rounded(opening.sill)},
                    {"thickness_m", rounded(opening.thickness)},
                    {"rooms", std::move(joined)}});
  }
  return list;
}

}  // namespace planum
