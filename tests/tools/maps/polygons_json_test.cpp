#include "tools/maps/polygons_json.hpp"

#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "meshing/polygons.hpp"
#include "slam/core/error.hpp"
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

Json written(const LabelledMap& map) {
  const TemporaryDirectory directory;
  write_polygons_json(directory / "polygons.json", map);
  return Json::parse(testing::text_of(directory / "polygons.json"));
}

Vector3d vector_of(const Json& json) {
  EXPECT_EQ(json.size(), 3u) << json;
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

std::set<std::string> keys(const Json& json) {
  std::set<std::string> result;
  for (const auto& [key, value] : json.items()) result.insert(key);
  return result;
}

/// The outer ring, then the holes.
std::vector<Ring> rings_of(const Json& polygon) {
  std::vector<Ring> rings = {polygon["outer"]};
  for (const Json& hole : polygon["holes"]) rings.push_back(hole);
  return rings;
}

/// Half the sum of cross products: its length is the area, its direction where it is
/// counter-clockwise from.
Vector3d area_vector(const Json& file, const Ring& ring) {
  Vector3d sum = Vector3d::Zero();
  const Vector3d first = vector_of(file["vertices"].at(ring[0]));
  for (std::size_t i = 2; i < ring.size(); ++i)
    sum += (vector_of(file["vertices"].at(ring[i - 1])) - first)
               .cross(vector_of(file["vertices"].at(ring[i])) - first) /
           2;
  return sum;
}

/// What docs/formats-results.md promises for every file; tolerance in metres.
void expect_laws(const Json& file, double tolerance) {
  EXPECT_EQ(keys(file), (std::set<std::string>{"version", "vertices", "polygons", "inferred",
                                               "rooms", "openings", "objects"}));
  EXPECT_EQ(file["version"], 1);
  std::set<std::uint32_t> used;
  for (std::size_t id = 0; id < file["polygons"].size(); ++id) {
    SCOPED_TRACE("polygon " + std::to_string(id));
    const Json& polygon = file["polygons"][id];
    EXPECT_EQ(keys(polygon), (std::set<std::string>{"id", "label", "confidence", "plane", "outer",
                                                    "holes", "area_m2", "room"}));
    EXPECT_EQ(keys(polygon["plane"]), (std::set<std::string>{"normal", "offset"}));
    EXPECT_EQ(polygon["id"], id);
    const Vector3d normal = vector_of(polygon["plane"]["normal"]);
    EXPECT_NEAR(normal.norm(), 1, 1e-8);
    double area = 0;
    const std::vector<Ring> rings = rings_of(polygon);
    for (std::size_t r = 0; r < rings.size(); ++r) {
      ASSERT_GE(rings[r].size(), 3u);
      EXPECT_EQ(std::set(rings[r].begin(), rings[r].end()).size(), rings[r].size());
      const double ring_area = normal.dot(area_vector(file, rings[r]));
      EXPECT_EQ(ring_area > 0, r == 0) << "ring " << r << " of " << ring_area << " m^2";
      area += ring_area;
      for (const std::uint32_t v : rings[r]) {
        used.insert(v);
        EXPECT_NEAR(normal.dot(vector_of(file["vertices"].at(v))), polygon["plane"]["offset"],
                    tolerance);
      }
    }
    EXPECT_NEAR(polygon["area_m2"], area, 1e-5 * area + 1e-6);
    EXPECT_GE(polygon["confidence"], 0);
    EXPECT_LE(polygon["confidence"], 1);
  }
  EXPECT_EQ(used.size(), file["vertices"].size()) << "vertices of no polygon";
}

TEST(PolygonsJson, KeepsItsLawsWhereverTheMapLies) {
  testing::Draws draws(1);
  expect_laws(written(small_map().labelled()), 1e-6);
  for (int i = 0; i < 20; ++i) expect_laws(written(small_map(draws.pose()).labelled()), 3e-6);
}

TEST(PolygonsJson, KeepsItsLawsForAPolygonizedScene) {
  TriangleMesh mesh = testing::moved(testing::furnished_room_mesh(0.1), testing::some_pose(0.35));
  testing::add_noise(mesh, 0.003, 5);
  SmallMap made;
  made.map = polygonize(mesh, grow_planes(mesh, region_params(0.1)), polygon_params(0.1));
  made.labels.polygons.resize(made.map.polygons.size());
  const Json file = written(made.labelled());
  ASSERT_EQ(file["polygons"].size(), 11u);
  std::size_t holes = 0;
  for (const Json& polygon : file["polygons"]) holes += polygon["holes"].size();
  EXPECT_EQ(holes, 3u);
  expect_laws(file, 6e-4);
}

TEST(PolygonsJson, HasFilledShadowsBesideThePolygons) {
  SmallMap small = small_map();
  MapPolygon shape = small.map.polygons[2];
  shape.area = 1.25;
  small.map.inferred = {{.polygon = 2, .shape = shape}};
  const Json file = written(small.labelled());
  ASSERT_EQ(file["inferred"].size(), 1u);
  const Json& patch = file["inferred"][0];
  EXPECT_EQ(keys(patch), (std::set<std::string>{"polygon", "outer", "holes", "area_m2"}));
  EXPECT_EQ(patch["polygon"], 2);
  EXPECT_EQ(patch["outer"], file["polygons"][2]["outer"]);
  EXPECT_EQ(patch["area_m2"], 1.25);
  expect_laws(file, 1e-6);
}

TEST(PolygonsJson, NeighboursShareVerticesAndRunOppositeWays) {
  const SmallMap small = small_map(testing::some_pose(1));
  const Json file = written(small.labelled());
  EXPECT_EQ(file["vertices"].size(), 16u);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const Json& polygon : file["polygons"])
    for (const Ring& ring : rings_of(polygon))
      for (std::size_t i = 0; i < ring.size(); ++i) ++uses[{ring[i], ring[(i + 1) % ring.size()]}];
  EXPECT_EQ(uses.size(), 2 * (12u + 12u) - 4u);  // the top of the box is no polygon
  std::size_t lonely = 0;
  for (const auto& [edge, count] : uses) {
    EXPECT_EQ(count, 1);
    lonely += uses.contains({edge.second, edge.first}) ? 0 : 1;
  }
  EXPECT_EQ(lonely, 4u);
}

TEST(PolygonsJson, NormalsLookIntoFreeSpace) {
  const Pose pose = testing::some_pose(0.7);
  const Json file = written(small_map(pose).labelled());
  // Gauss: of a closed surface with normals inwards, sum of offset * area = -3 volume. The top of
  // the box is missing.
  const double top = (pose.linear() * Vector3d::UnitZ()).dot(pose * Vector3d(1, 1, 0.7)) * 0.8;
  double sum = top;
  for (const Json& polygon : file["polygons"])
    sum += polygon["plane"]["offset"].get<double>() * polygon["area_m2"].get<double>();
  EXPECT_NEAR(sum, -3 * testing::small_map_volume, 1e-4);
  const Vector3d above_the_box = pose * Vector3d(1.5, 1.4, 2);
  for (std::size_t id = 0; id < 6; ++id) {
    const Json& plane = file["polygons"][id]["plane"];
    EXPECT_GT(vector_of(plane["normal"]).dot(above_the_box), plane["offset"]) << id;
  }
}

TEST(PolygonsJson, GivesBackTheMap) {
  const SmallMap small = small_map(testing::some_pose(2));
  const Json file = written(small.labelled());
  ASSERT_EQ(file["vertices"].size(), small.map.vertices.size());
  for (std::size_t i = 0; i < small.map.vertices.size(); ++i)
    EXPECT_LT((vector_of(file["vertices"][i]) - small.map.vertices[i]).norm(), 1e-6);
  ASSERT_EQ(file["polygons"].size(), small.map.polygons.size());
  for (std::size_t id = 0; id < small.map.polygons.size(); ++id) {
    const Json& polygon = file["polygons"][id];
    EXPECT_EQ(polygon["outer"].get<Ring>(), small.map.polygons[id].outer);
    EXPECT_EQ(polygon["holes"].get<std::vector<Ring>>(), small.map.polygons[id].holes);
    EXPECT_EQ(polygon["label"], name(small.labels.polygons[id].label));
    EXPECT_NEAR(polygon["confidence"], small.labels.polygons[id].confidence, 0.00051);
    EXPECT_EQ(polygon["room"], id < 6 ? Json("room 1") : Json(nullptr));
  }
  ASSERT_EQ(file["rooms"].size(), 1u);
  EXPECT_EQ(file["rooms"][0]["name"], "room 1");
}

TEST(PolygonsJson, OfNothingIsAFileToo) {
  const SmallMap none;
  const Json file = written(none.labelled());
  expect_laws(file, 0);
  for (const char* list : {"vertices", "polygons", "rooms", "openings", "objects"})
    EXPECT_EQ(file[list], Json::array()) << list;
}

TEST(PolygonsJson, WithoutRoomsHasNullForEach) {
  SmallMap small = small_map();
  small.rooms = {};
  const Json file = written(small.labelled());
  for (const Json& polygon : file["polygons"]) EXPECT_TRUE(polygon["room"].is_null());
}

TEST(PolygonsJson, TakesAnyRoomName) {
  SmallMap small = small_map();
  for (const std::string name : {"\"Küche\"\\\n", "", "a\tb"}) {
    small.rooms.rooms[0].name = name;
    const Json file = written(small.labelled());
    EXPECT_EQ(file["polygons"][0]["room"], name);
    EXPECT_EQ(file["rooms"][0]["name"], name);
  }
}

TEST(PolygonsJson, SaysWhenLabelsOrRoomsAreOfAnotherMap) {
  const TemporaryDirectory directory;
  const auto path = directory / "polygons.json";
  SmallMap small = small_map();
  small.labels.polygons.pop_back();
  EXPECT_EQ(testing::error_of([&] { write_polygons_json(path, small.labelled()); }),
            path.string() + ": 10 polygons with 9 labels and 10 rooms");
  small = small_map();
  small.rooms.room_of_polygon.push_back(0);
  EXPECT_EQ(testing::error_of([&] { write_polygons_json(path, small.labelled()); }),
            path.string() + ": 10 polygons with 10 labels and 11 rooms");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(PolygonsJson, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  const auto path = directory.path() / "absent" / "polygons.json";
  testing::expect_cannot_write(path, [&] { write_polygons_json(path, small.labelled()); });
}

}  // namespace
}  // namespace planum
