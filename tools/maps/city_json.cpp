#include "tools/maps/city_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/city_geometry.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

constexpr double max_distance = 0.01;  // m, of a vertex from its plane: what validators accept

double rounded(double value) { return std::round(1e4 * value) / 1e4; }

bool is_furniture(Label label) {
  return label == Label::furniture_horizontal || label == Label::furniture_vertical;
}

/// The type of semantic surface for a label, or null.
const char* surface_type(Label label) {
  switch (label) {
    case Label::floor:
      return "FloorSurface";
    case Label::ceiling:
      return "CeilingSurface";
    case Label::wall:
      return "InteriorWallSurface";
    case Label::door:
      return "Door";
    case Label::window:
      return "Window";
    default:
      return nullptr;
  }
}

/// The type of semantic surface that closes a room where an opening is.
const char* surface_type(OpeningKind kind) {
  switch (kind) {
    case OpeningKind::door:
      return "Door";
    case OpeningKind::window:
      return "Window";
    case OpeningKind::passage:
      break;
  }
  return "ClosureSurface";
}

void check(const std::filesystem::path& path, const LabelledMap& map) {
  const std::size_t polygons = map.map.polygons.size();
  if (polygons == 0) throw Error(path.string() + ": there is no polygon for it");
  if (map.labels.polygons.size() != polygons || map.rooms.room_of_polygon.size() != polygons)
    throw Error(fmt::format("{}: {} polygons with {} labels, {} of them with or without a room",
                            path.string(), polygons, map.labels.polygons.size(),
                            map.rooms.room_of_polygon.size()));
}

/// Whether a validator would take it for a surface.
bool is_plane(const PolygonMap& map, const MapPolygon& polygon) {
  const auto lies_in = [&](const Ring& ring) {
    return std::all_of(ring.begin(), ring.end(), [&](std::uint32_t v) {
      return std::abs(polygon.plane.signed_distance(map.vertices.at(v))) <= max_distance;
    });
  };
  return lies_in(polygon.outer) && std::all_of(polygon.holes.begin(), polygon.holes.end(), lies_in);
}

/// Groups of polygons of a kind that hang together at vertices and are of the same room.
class Pieces {
 public:
  explicit Pieces(std::size_t polygons) : parent_(polygons) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::size_t a, std::size_t b) {
    const std::size_t one = root(a), other = root(b);
    parent_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Positions of the polygons that `is_wanted`, by pieces in the order of the map.
template <typename IsWanted>
std::vector<std::vector<std::size_t>> pieces_of(const LabelledMap& map, const IsWanted& is_wanted) {
  const std::vector<MapPolygon>& polygons = map.map.polygons;
  Pieces pieces(polygons.size());
  std::map<std::pair<std::int32_t, std::uint32_t>, std::size_t> first_at;  // room and vertex
  const auto join_at = [&](std::size_t i, const Ring& ring) {
    for (const std::uint32_t v : ring)
      pieces.join(i, first_at.try_emplace({map.rooms.room_of_polygon[i], v}, i).first->second);
  };
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    if (!is_wanted(map.labels.polygons[i].label)) continue;
    join_at(i, polygons[i].outer);
    for (const Ring& hole : polygons[i].holes) join_at(i, hole);
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < polygons.size(); ++i)
    if (is_wanted(map.labels.polygons[i].label)) groups[pieces.root(i)].push_back(i);
  std::vector<std::vector<std::size_t>> result;
  for (auto& [first, group] : groups) result.push_back(std::move(group));
  return result;
}

/// The hole of an opening, halfway through the wall, counter-clockwise seen from `room`.
std::vector<Vector3d> closing_ring(const Opening& opening, std::size_t room,
                                   const Room& seen_from) {
  Vector3d inwards = opening.across;
  if (opening.rooms.size() > 1 ? opening.rooms[0] == room
                               : inwards.dot(seen_from.centre - opening.position) < 0)
    inwards = -inwards;
  const Vector3d up = 0.5 * opening.height * Vector3d::UnitZ();
  const Vector3d right = 0.5 * opening.width * Vector3d::UnitZ().cross(inwards).normalized();
  const Vector3d& middle = opening.position;
  return {middle - right - up, middle + right - up, middle + right + up, middle - right + up};
}

/// Puts the objects of a building together.
class CityWriter {
 public:
  explicit CityWriter(const LabelledMap& map)
      : map_(map),
        vertices_(lowest(map.map.vertices)),
        surfaces_(map.rooms.rooms.size() + 1, CitySurfaces(vertices_)) {
    for (std::size_t i = 0; i < map.map.polygons.size(); ++i)
      if (!is_plane(map.map, map.map.polygons[i])) left_out_.push_back(i);
  }

  Json city_json() {
    add_object("building", "Building", "", {{"storeys", map_.rooms.storeys.size()}});
    if (!left_out_.empty()) objects_["building"]["attributes"]["left_out"] = left_out_;
    add_storeys();
    add_polygons();
    add_room_floors();
    add_openings();
    add_rooms();
    objects_["building"]["geometry"] = surfaces_.back().geometry_json();
    add_pieces("furniture", "BuildingFurniture", is_furniture);
    add_pieces("stair", "BuildingInstallation", [](Label label) { return label == Label::stair; });
    return {{"type", "CityJSON"},
            {"version", "2.0"},
            {"transform", vertices_.transform_json()},
            {"metadata", {{"title", "polygon map of planum"}}},
            {"CityObjects", objects_},
            {"vertices", vertices_.vertices_json()}};
  }

 private:
  static Vector3d lowest(const std::vector<Vector3d>& vertices) {
    Vector3d result = vertices.front();
    for (const Vector3d& v : vertices) result = result.cwiseMin(v);
    return result.unaryExpr(&rounded);
  }

  static std::string room_id(std::size_t room) { return fmt::format("room-{}", room + 1); }

  void add_object(const std::string& id, const char* type, const std::string& parent,
                  Json attributes) {
    Json& object = objects_[id];
    object = {{"type", type}, {"attributes", std::move(attributes)}, {"geometry", Json::array()}};
    if (parent.empty()) return;
    object["parents"] = Json::array({parent});
    objects_[parent]["children"].push_back(id);
  }

  void add_storeys() {
    for (std::size_t i = 0; i < map_.rooms.storeys.size(); ++i)
      add_object(fmt::format("storey-{}", i + 1), "BuildingStorey", "building",
                 {{"floor_m", rounded(map_.rooms.storeys[i])}});
  }

  /// The surfaces of a room, or of the building.
  CitySurfaces& surfaces_of(std::int32_t room) {
    return room < 0 ? surfaces_.back() : surfaces_.at(static_cast<std::size_t>(room));
  }

  Json semantics_of(std::size_t polygon, bool is_inferred) const {
    const PolygonLabel& label = map_.labels.polygons[polygon];
    const char* const type = surface_type(label.label);
    if (!type) return nullptr;
    Json result = {{"type", type}, {"polygon", polygon}};
    if (is_inferred)
      result["inferred"] = true;
    else
      result["confidence"] = std::round(1000 * label.confidence) / 1000;
    return result;
  }

  /// All but furniture and stairs, which are objects of their own.
  void add_polygons() {
    const auto add = [&](std::size_t polygon, const MapPolygon& shape, bool is_inferred) {
      const Label label = map_.labels.polygons.at(polygon).label;
      if (!is_furniture(label) && label != Label::stair && is_plane(map_.map, shape))
        surfaces_of(map_.rooms.room_of_polygon[polygon])
            .add(map_.map.vertices, shape, semantics_of(polygon, is_inferred));
    };
    for (std::size_t i = 0; i < map_.map.polygons.size(); ++i) add(i, map_.map.polygons[i], false);
    for (const InferredPatch& patch : map_.map.inferred) add(patch.polygon, patch.shape, true);
  }

  /// A floor that goes through several rooms is of none: these get their outline.
  void add_room_floors() {
    std::vector<bool> has_floor(map_.rooms.rooms.size(), false);
    for (std::size_t i = 0; i < map_.map.polygons.size(); ++i)
      if (const std::int32_t room = map_.rooms.room_of_polygon[i];
          room >= 0 && map_.labels.polygons[i].label == Label::floor)
        has_floor.at(static_cast<std::size_t>(room)) = true;
    for (std::size_t i = 0; i < map_.rooms.rooms.size(); ++i)
      if (!has_floor[i])
        surfaces_[i].add(map_.rooms.rooms[i].outline,
                         {{"type", "FloorSurface"}, {"outline", true}});
  }

  void add_openings() {
    for (std::size_t i = 0; i < map_.rooms.openings.size(); ++i) {
      const Opening& opening = map_.rooms.openings[i];
      for (const std::size_t room : opening.rooms)
        surfaces_.at(room).add(closing_ring(opening, room, map_.rooms.rooms.at(room)),
                               {{"type", surface_type(opening.kind)},
                                {"opening", i},
                                {"kind", name(opening.kind)},
                                {"width_m", rounded(opening.width)},
                                {"height_m", rounded(opening.height)}});
    }
  }

  void add_rooms() {
    for (std::size_t i = 0; i < map_.rooms.rooms.size(); ++i) {
      const Room& room = map_.rooms.rooms[i];
      const std::string parent = room.storey < map_.rooms.storeys.size()
                                     ? fmt::format("storey-{}", room.storey + 1)
                                     : "building";
      add_object(room_id(i), "BuildingRoom", parent,
                 {{"name", room.name},
                  {"area_m2", rounded(room.area)},
                  {"width_m", rounded(room.width)},
                  {"depth_m", rounded(room.depth)},
                  {"height_m", rounded(room.height)}});
      objects_[room_id(i)]["geometry"] = surfaces_[i].geometry_json();
    }
  }

  template <typename IsWanted>
  void add_pieces(const char* kind, const char* type, const IsWanted& is_wanted) {
    std::size_t count = 0;
    for (const std::vector<std::size_t>& piece : pieces_of(map_, is_wanted)) {
      const std::int32_t room = map_.rooms.room_of_polygon[piece.front()];
      const std::string id = fmt::format("{}-{}", kind, ++count);
      CitySurfaces surfaces(vertices_);
      for (const std::size_t i : piece)
        if (is_plane(map_.map, map_.map.polygons[i]))
          surfaces.add(map_.map.vertices, map_.map.polygons[i]);
      add_object(id, type, room < 0 ? "building" : room_id(static_cast<std::size_t>(room)),
                 {{"function", kind}, {"polygons", piece}});
      objects_[id]["geometry"] = surfaces.geometry_json();
    }
  }

  const LabelledMap& map_;
  CityVertices vertices_;
  std::vector<CitySurfaces> surfaces_;  ///< of each room, then of the building
  std::vector<std::size_t> left_out_;   ///< polygons that are not plane
  Json objects_ = Json::object();
};

}  // namespace

void write_city_json(const std::filesystem::path& path, const LabelledMap& map) {
  check(path, map);
  write_file_atomically(path, CityWriter(map).city_json().dump() + "\n");
}

}  // namespace planum
