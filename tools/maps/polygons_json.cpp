#include "tools/maps/polygons_json.hpp"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/object_json.hpp"
#include "tools/maps/room_json.hpp"

namespace planum {
namespace {

using Text = std::back_insert_iterator<std::string>;

/// "[1,2,3]"; written by hand since a library's tree of a large map takes a hundred times its size.
void append_ring(std::string& text, const Ring& ring) {
  text += '[';
  for (std::size_t i = 0; i < ring.size(); ++i)
    fmt::format_to(Text(text), "{}{}", i ? "," : "", ring[i]);
  text += ']';
}

void append_rings(std::string& text, const MapPolygon& polygon) {
  text += "\"outer\":";
  append_ring(text, polygon.outer);
  text += ",\"holes\":[";
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    if (i) text += ',';
    append_ring(text, polygon.holes[i]);
  }
  fmt::format_to(Text(text), "],\"area_m2\":{:.6f}", polygon.area);
}

void append_inferred(std::string& text, const PolygonMap& map) {
  text += "],\n\"inferred\":[";
  for (std::size_t i = 0; i < map.inferred.size(); ++i) {
    fmt::format_to(Text(text), "{}\n{{\"polygon\":{},", i ? "," : "", map.inferred[i].polygon);
    append_rings(text, map.inferred[i].shape);
    text += '}';
  }
}

void append_polygon(std::string& text, std::size_t id, const LabelledMap& map) {
  const MapPolygon& polygon = map.map.polygons[id];
  const PolygonLabel& label = map.labels.polygons[id];
  const Eigen::Vector3d& n = polygon.plane.normal;
  fmt::format_to(
      Text(text),
      "{{\"id\":{},\"label\":\"{}\",\"confidence\":{:.3f},\"plane\":{{\"normal\":[{:.9f},"
      "{:.9f},{:.9f}],\"offset\":{:.6f}}},",
      id, name(label.label), label.confidence, n.x(), n.y(), n.z(), polygon.plane.offset);
  append_rings(text, polygon);
  text += ",\"room\":";
  const auto& rooms = map.rooms.room_of_polygon;
  const std::int32_t room = rooms.empty() ? -1 : rooms[id];
  text += room < 0 ? "null" : nlohmann::json(map.rooms.rooms[std::size_t(room)].name).dump();
  text += '}';
}

}  // namespace

void write_polygons_json(const std::filesystem::path& path, const LabelledMap& map) {
  const std::size_t count = map.map.polygons.size();
  if (map.labels.polygons.size() != count ||
      (!map.rooms.room_of_polygon.empty() && map.rooms.room_of_polygon.size() != count))
    throw Error(fmt::format("{}: {} polygons with {} labels and {} rooms", path.string(), count,
                            map.labels.polygons.size(), map.rooms.room_of_polygon.size()));
  std::string text = "{\"version\":1,\n\"vertices\":[";
  for (std::size_t i = 0; i < map.map.vertices.size(); ++i) {
    const Eigen::Vector3d& v = map.map.vertices[i];
    fmt::format_to(Text(text), "{}\n[{:.6f},{:.6f},{:.6f}]", i ? "," : "", v.x(), v.y(), v.z());
  }
  text += "],\n\"polygons\":[";
  for (std::size_t id = 0; id < count; ++id) {
    text += id ? ",\n" : "\n";
    append_polygon(text, id, map);
  }
  append_inferred(text, map.map);
  text += "],\n\"rooms\":" + rooms_json(map.rooms).dump();
  text += ",\n\"openings\":" + openings_json(map.rooms).dump();
  // Models are named after files, whose names may be of any encoding.
  text += ",\n\"objects\":" +
          objects_json(map.objects, map.rooms)
              .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
          "}\n";
  write_file_atomically(path, text);
}

}  // namespace planum
