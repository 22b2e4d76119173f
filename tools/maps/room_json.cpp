#include "tools/maps/room_json.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

/// Tenths of millimetres: more would be noise to a reader.
double rounded(double metres) { return std::round(metres * 1e4) / 1e4; }

Json point_json(const Eigen::Vector3d& p) {
  return Json::array({rounded(p.x()), rounded(p.y()), rounded(p.z())});
}

}  // namespace

Json rooms_json(const RoomMap& rooms) {
  Json list = Json::array();
  for (const Room& room : rooms.rooms) {
    Json outline = Json::array();
    for (const Eigen::Vector3d& p : room.outline) outline.push_back(point_json(p));
    list.push_back({{"name", room.name},
                    {"storey", room.storey + 1},
                    {"centre", point_json(room.centre)},
                    {"area_m2", rounded(room.area)},
                    {"width_m", rounded(room.width)},
                    {"depth_m", rounded(room.depth)},
                    {"height_m", rounded(room.height)},
                    {"depth_direction", point_json(room.along)},
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
