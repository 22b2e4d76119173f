#include "tools/maps/object_json.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include <nlohmann/json.hpp>

#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value) { return std::round(value * 1e4) / 1e4; }

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({rounded(v.x()), rounded(v.y()), rounded(v.z())});
}

Json model_json(const ModelMatch& match) {
  const Pose& pose = match.world_from_model;
  return {{"name", match.name},
          {"score", rounded(match.score())},
          {"explained", rounded(match.explained)},
          {"seen", rounded(match.seen)},
          {"position", vector_json(pose.translation())},
          {"yaw_deg", rounded(degrees(std::atan2(pose(1, 0), pose(0, 0))))},
          {"scale", vector_json(match.scale)}};
}

}  // namespace

Json objects_json(std::span<const SceneObject> objects, const RoomMap& rooms) {
  Json list = Json::array();
  for (std::size_t id = 0; id < objects.size(); ++id) {
    const SceneObject& object = objects[id];
    Json model = object.model ? model_json(*object.model) : Json();
    list.push_back({{"id", id},
                    {"room", rooms.rooms[object.room].name},
                    {"centre", vector_json(object.box.centre)},
                    {"size_m", vector_json(object.box.size)},
                    {"along", vector_json(object.box.along)},
                    {"on_floor", object.is_on_floor},
                    {"points", object.points.size()},
                    {"polygons", object.polygons},
                    {"model", std::move(model)}});
  }
  return list;
}

}  // namespace planum
