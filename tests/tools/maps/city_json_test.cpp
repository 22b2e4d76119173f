#include "tools/maps/city_json.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "tests/meshing/scenes.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;
using testing::small_map;
using testing::SmallMap;
using testing::TemporaryDirectory;

/// A CityJSON file, and what the specification asks of it.
struct City {
  Json json;
  std::vector<Vector3d> vertices;
  std::set<std::size_t> used;

  explicit City(const std::filesystem::path& path) : json(Json::parse(testing::text_of(path))) {
    EXPECT_EQ(json["type"], "CityJSON");
    EXPECT_EQ(json["version"], "2.0");
    const Json& transform = json["transform"];
    std::set<Json> places;
    for (const Json& vertex : json["vertices"]) {
      EXPECT_EQ(vertex.size(), 3u);
      EXPECT_TRUE(places.insert(vertex).second) << "a vertex is there twice";
      Vector3d& p = vertices.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_TRUE(vertex[k].is_number_integer());
        p[static_cast<int>(k)] = vertex[k].get<double>() * transform["scale"][k].get<double>() +
                                 transform["translate"][k].get<double>();
      }
    }
    for (const auto& [id, object] : json["CityObjects"].items()) check(id, object);
    EXPECT_EQ(used.size(), vertices.size()) << "a vertex is in no ring";
  }

  const Json& object(const std::string& id) const { return json["CityObjects"].at(id); }

  /// Surfaces of a room by type of their semantics; "" for none.
  std::map<std::string, int> types(const std::string& id) const {
    std::map<std::string, int> result;
    const Json& geometry = object(id)["geometry"][0];
    for (const Json& value : geometry["semantics"]["values"])
      ++result[value.is_null() ? ""
                               : geometry["semantics"]["surfaces"][value.get<std::size_t>()]["type"]
                                     .get<std::string>()];
    return result;
  }

  std::vector<Vector3d> ring(const Json& indices) const {
    std::vector<Vector3d> result;
    for (const Json& i : indices) result.push_back(vertices.at(i.get<std::size_t>()));
    return result;
  }

  /// Twice the area, along the normal (right-handed).
  static Vector3d doubled_area(const std::vector<Vector3d>& ring) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < ring.size(); ++i)
      sum += (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]);
    return sum;
  }

 private:
  void check(const std::string& id, const Json& object) {
    static const std::set<std::string> types = {"Building", "BuildingStorey", "BuildingRoom",
                                                "BuildingFurniture", "BuildingInstallation"};
    EXPECT_TRUE(types.contains(object["type"])) << id;
    EXPECT_EQ(object["type"] == "Building", !object.contains("parents")) << id;
    for (const Json& parent : object.value("parents", Json::array())) {
      const Json& children = json["CityObjects"].at(parent.get<std::string>())["children"];
      EXPECT_NE(std::find(children.begin(), children.end(), Json(id)), children.end()) << id;
    }
    for (const Json& child : object.value("children", Json::array())) {
      const Json& parents = json["CityObjects"].at(child.get<std::string>())["parents"];
      EXPECT_EQ(parents, Json::array({id}));
    }
    ASSERT_TRUE(object["geometry"].is_array());
    for (const Json& geometry : object["geometry"]) check_geometry(id, geometry);
  }

  void check_geometry(const std::string& id, const Json& geometry) {
    EXPECT_EQ(geometry["type"], "MultiSurface");
    EXPECT_TRUE(geometry["lod"].is_string());
    ASSERT_FALSE(geometry["boundaries"].empty()) << id;
    for (const Json& surface : geometry["boundaries"]) check_surface(id, surface);
    if (!geometry.contains("semantics")) return;
    static const std::set<std::string> types = {
        "FloorSurface", "CeilingSurface", "InteriorWallSurface",
        "Door",         "Window",         "ClosureSurface"};
    const Json &surfaces = geometry["semantics"]["surfaces"],
               &values = geometry["semantics"]["values"];
    EXPECT_EQ(values.size(), geometry["boundaries"].size()) << id;
    for (const Json& value : values)
      EXPECT_TRUE(value.is_null() || value.get<std::size_t>() < surfaces.size()) << id;
    for (const Json& surface : surfaces) EXPECT_TRUE(types.contains(surface["type"])) << id;
  }

  void check_surface(const std::string& id, const Json& surface) {
    const std::vector<Vector3d> outer = ring(surface[0]);
    const Vector3d normal = doubled_area(outer).normalized();
    for (std::size_t r = 0; r < surface.size(); ++r) {
      EXPECT_GE(surface[r].size(), 3u) << id;
      const std::vector<Vector3d> corners = ring(surface[r]);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        used.insert(surface[r][i].get<std::size_t>());
        EXPECT_NE(surface[r][i], surface[r][(i + 1) % corners.size()]) << id;
        EXPECT_NEAR(normal.dot(corners[i] - outer[0]), 0, 1e-3) << id << " is not plane";
      }
      EXPECT_EQ(doubled_area(corners).dot(normal) > 0, r == 0) << id << ": a ring turns wrongly";
    }
  }
};

City written(const SmallMap& small) {
  const TemporaryDirectory directory;
  write_city_json(directory / "map.city.json", small.labelled());
  return City(directory / "map.city.json");
}

TEST(CityJson, HasARoomOfItsSurfaces) {
  const City city = written(small_map(testing::some_pose(4)));
  EXPECT_EQ(city.types("room-1"),
            (std::map<std::string, int>{
                {"FloorSurface", 1}, {"CeilingSurface", 1}, {"InteriorWallSurface", 4}}));
  EXPECT_EQ(city.object("room-1")["type"], "BuildingRoom");
  EXPECT_EQ(city.object("room-1")["attributes"]["name"], "room 1");
  EXPECT_EQ(city.object("room-1")["attributes"]["height_m"], 2.5);
  EXPECT_EQ(city.object("room-1")["parents"], Json::array({"building"}));
  // The sides of the box are in no room, and nobody knows what they are.
  EXPECT_EQ(city.object("building")["geometry"][0]["boundaries"].size(), 4u);
  EXPECT_FALSE(city.object("building")["geometry"][0].contains("semantics"));
}

TEST(CityJson, SurfacesAreSeenFromFreeSpace) {
  const SmallMap small = small_map(testing::some_pose(5));
  const City city = written(small);
  const Json& geometry = city.object("room-1")["geometry"][0];
  for (std::size_t i = 0; i < geometry["boundaries"].size(); ++i) {
    const Json& semantics = geometry["semantics"]["surfaces"][i];
    const MapPolygon& polygon = small.map.polygons[semantics["polygon"].get<std::size_t>()];
    double area = 0;
    for (const Json& ring : geometry["boundaries"][i])
      area += City::doubled_area(city.ring(ring)).dot(polygon.plane.normal) / 2;
    EXPECT_NEAR(area, polygon.area, 2e-3);
  }
}

TEST(CityJson, ClosesRoomsAtOpeningsFromBothSides) {
  SmallMap small = small_map();
  small.rooms.storeys = {0};
  Room other = small.rooms.rooms[0];
  other.name = "room 2";
  other.centre.x() += 4.2;
  for (Vector3d& p : other.outline) p.x() += 4.2;
  small.rooms.rooms.push_back(other);
  Opening door;
  door.position = {4.1, 1.5, 1};
  door.across = Vector3d::UnitX();
  door.width = 0.9;
  door.height = 2;
  door.rooms = {0, 1};
  Opening window = door, passage = door;
  window.kind = OpeningKind::window;
  window.position = {-0.1, 1.5, 1.5};
  window.rooms = {0};
  passage.kind = OpeningKind::passage;
  passage.position.y() = 2.5;
  small.rooms.openings = {door, window, passage};
  const City city = written(small);
  EXPECT_EQ(city.types("room-1")["Door"], 1);
  EXPECT_EQ(city.types("room-1")["Window"], 1);
  EXPECT_EQ(city.types("room-1")["ClosureSurface"], 1);
  // No polygon is the floor of room 2: its outline is.
  EXPECT_EQ(city.types("room-2"),
            (std::map<std::string, int>{{"FloorSurface", 1}, {"Door", 1}, {"ClosureSurface", 1}}));
  EXPECT_EQ(city.object("room-2")["parents"], Json::array({"storey-1"}));
  EXPECT_EQ(city.object("storey-1")["parents"], Json::array({"building"}));
  const auto seen_along = [&](const std::string& id, std::size_t opening) -> double {
    const Json& geometry = city.object(id)["geometry"][0];
    for (std::size_t i = 0; i < geometry["boundaries"].size(); ++i)
      if (geometry["semantics"]["surfaces"][i].value("opening", std::size_t{99}) == opening)
        return City::doubled_area(city.ring(geometry["boundaries"][i][0])).x() / 2;
    return 0;
  };
  EXPECT_NEAR(seen_along("room-1", 0), -0.9 * 2, 1e-3);
  EXPECT_NEAR(seen_along("room-2", 0), 0.9 * 2, 1e-3);
  EXPECT_NEAR(seen_along("room-1", 1), 0.9 * 2, 1e-3);
}

TEST(CityJson, MakesObjectsOfFurnitureAndStairs) {
  SmallMap small = small_map();
  for (std::size_t i = 6; i < 10; ++i) {
    small.labels.polygons[i].label = Label::furniture_vertical;
    small.rooms.room_of_polygon[i] = 0;
  }
  City city = written(small);
  EXPECT_EQ(city.object("furniture-1")["type"], "BuildingFurniture");
  EXPECT_EQ(city.object("furniture-1")["parents"], Json::array({"room-1"}));
  EXPECT_EQ(city.object("furniture-1")["geometry"][0]["boundaries"].size(), 4u);
  EXPECT_EQ(city.object("furniture-1")["attributes"]["polygons"], Json::array({6, 7, 8, 9}));
  EXPECT_FALSE(city.json["CityObjects"].contains("furniture-2"));
  small.labels.polygons[9].label = Label::stair;
  city = written(small);
  EXPECT_EQ(city.object("stair-1")["type"], "BuildingInstallation");
  EXPECT_EQ(city.object("furniture-1")["geometry"][0]["boundaries"].size(), 3u);
}

TEST(CityJson, MarksWhatNobodySaw) {
  SmallMap small = small_map();
  small.map.inferred = {{.polygon = 3, .shape = small.map.polygons[3]}};
  const City city = written(small);
  const Json& surfaces = city.object("room-1")["geometry"][0]["semantics"]["surfaces"];
  EXPECT_EQ(surfaces[6]["type"], "InteriorWallSurface");
  EXPECT_EQ(surfaces[6]["inferred"], true);
  EXPECT_FALSE(surfaces[5].contains("inferred"));
}

TEST(CityJson, LeavesOutWhatIsNotPlaneAndSaysSo) {
  const TemporaryDirectory directory;
  SmallMap small = small_map();
  small.map.polygons[2].plane.offset += 0.05;
  write_city_json(directory / "a.city.json", small.labelled());
  const Json json = Json::parse(testing::text_of(directory / "a.city.json"));
  EXPECT_EQ(json["CityObjects"]["building"]["attributes"]["left_out"], Json::array({2}));
  const std::string text = json.dump();
  EXPECT_EQ(text.find("\"polygon\":2,"), std::string::npos);
  EXPECT_NE(text.find("\"polygon\":1,"), std::string::npos);
}

TEST(CityJson, RefusesWhatIsNoMap) {
  const TemporaryDirectory directory;
  const auto error = [&](const SmallMap& small) {
    return testing::error_of([&] { write_city_json(directory / "a.city.json", small.labelled()); });
  };
  EXPECT_NE(error({}).find("there is no polygon for it"), std::string::npos);
  SmallMap small = small_map();
  small.labels.polygons.pop_back();
  EXPECT_NE(error(small).find("10 polygons with 9 labels"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

}  // namespace
}  // namespace planum
