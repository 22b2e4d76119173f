#include "tools/maps/map_glb.hpp"

#include <cstring>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"

namespace planum {
namespace {

using Json = nlohmann::json;
using testing::small_map;
using testing::SmallMap;
using testing::TemporaryDirectory;

/// A .glb by the specification of glTF 2.0 alone.
struct Glb {
  Json json;
  std::string data;

  explicit Glb(const std::filesystem::path& path) {
    const std::string file = testing::text_of(path);
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(number(file, 4), 2u);
    EXPECT_EQ(number(file, 8), file.size());
    const std::uint32_t length = number(file, 12);
    EXPECT_EQ(length % 4, 0u);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    json = Json::parse(file.substr(20, length));
    EXPECT_EQ(number(file, 20 + length), file.size() - 28 - length);
    EXPECT_EQ(file.substr(24 + length, 4), std::string("BIN\0", 4));
    data = file.substr(28 + length);
    EXPECT_EQ(json["buffers"][0]["byteLength"], data.size());
  }

  static std::uint32_t number(const std::string& text, std::size_t at) {
    std::uint32_t result = 0;
    std::memcpy(&result, text.data() + at, 4);
    return result;
  }

  /// Where value i of an accessor begins; checks that it is within its view.
  std::size_t place(std::size_t accessor, std::size_t i, std::size_t bytes) const {
    const Json& a = json["accessors"][accessor];
    const Json& view = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::size_t at = a["byteOffset"].get<std::size_t>() + i * bytes;
    EXPECT_LT(i, a["count"].get<std::size_t>());
    EXPECT_LE(at + bytes, view["byteLength"].get<std::size_t>());
    return view["byteOffset"].get<std::size_t>() + at;
  }

  Eigen::Vector3f position(std::size_t accessor, std::size_t i) const {
    Eigen::Vector3f p;
    std::memcpy(p.data(), data.data() + place(accessor, i, 12), 12);
    return p;
  }

  /// m^2, of the triangles of a node; checks that bounds are tight and all vertices used.
  double area(const Json& node) const {
    const Json& primitive = json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    const std::size_t positions = primitive["attributes"]["POSITION"],
                      indices = primitive["indices"];
    std::set<std::uint32_t> used;
    double sum = 0;
    Eigen::AlignedBox3f box;
    for (std::size_t i = 0; i < json["accessors"][indices]["count"]; i += 3) {
      Eigen::Vector3f p[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = number(data, place(indices, i + k, 4));
        used.insert(v);
        p[k] = position(positions, v);
        box.extend(p[k]);
      }
      sum += 0.5 * static_cast<double>((p[1] - p[0]).cross(p[2] - p[0]).norm());
    }
    EXPECT_EQ(used.size(), json["accessors"][positions]["count"].get<std::size_t>());
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(json["accessors"][positions]["min"][std::size_t(k)].get<float>(), box.min()[k]);
      EXPECT_EQ(json["accessors"][positions]["max"][std::size_t(k)].get<float>(), box.max()[k]);
    }
    return sum;
  }
};

TEST(MapGlb, HasANodeForEveryPolygonWithWhatItIs) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  write_map_glb(directory / "map.glb", triangulated(small.map), small.labelled());
  const Glb glb(directory / "map.glb");
  const Json& nodes = glb.json["nodes"];
  ASSERT_EQ(nodes.size(), 12u);  // the root, ten polygons, the rest
  EXPECT_EQ(nodes[0]["children"].size(), 11u);
  EXPECT_EQ(nodes[1]["name"], "floor 0");
  EXPECT_EQ(nodes[1]["extras"]["label"], "floor");
  EXPECT_EQ(nodes[1]["extras"]["room"], "room 1");
  EXPECT_EQ(nodes[11]["name"], "rest");
  std::set<std::string> names;
  for (std::size_t i = 1; i < 12; ++i) {
    names.insert(nodes[i]["name"]);
    EXPECT_NEAR(glb.area(nodes[i]), i < 11 ? small.map.polygons[i - 1].area : 0.8, 1e-4);
  }
  EXPECT_EQ(names.size(), 11u);
  EXPECT_EQ(glb.json["materials"].size(), 5u);
}

TEST(MapGlb, TurnsUpwardsIntoY) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  write_map_glb(directory / "map.glb", triangulated(small.map), small.labelled());
  const auto q = Glb(directory / "map.glb").json["nodes"][0]["rotation"].get<std::vector<double>>();
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  EXPECT_LT((turn * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((turn * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm(), 1e-9);
}

TEST(MapGlb, ShowsFilledShadowsThroughAMaterialOfTheirOwn) {
  const TemporaryDirectory directory;
  SmallMap small = small_map();
  small.map.inferred = {{.polygon = 3, .shape = small.map.polygons[3]}};
  write_map_glb(directory / "map.glb", triangulated(small.map), small.labelled());
  const Glb glb(directory / "map.glb");
  const Json& node = glb.json["nodes"][11];
  EXPECT_EQ(node["name"], "wall 3, inferred");
  EXPECT_EQ(node["extras"]["inferred"], true);
  EXPECT_NEAR(glb.area(node), small.map.polygons[3].area, 1e-4);
  const std::size_t material =
      glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0]["material"];
  EXPECT_EQ(glb.json["materials"][material]["alphaMode"], "BLEND");
}

TEST(MapGlb, HoldsTheTexturesOfItsLabels) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  const auto frames = texture_frames(small.map, small.labels);
  write_map_glb(directory / "map.glb", triangulated(small.map), small.labelled(), frames);
  const Glb glb(directory / "map.glb");
  ASSERT_EQ(glb.json["images"].size(), 4u);  // unknown, floor, ceiling, wall
  for (const Json& image : glb.json["images"]) {
    const Json& view = glb.json["bufferViews"][image["bufferView"].get<std::size_t>()];
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_EQ(glb.data.substr(view["byteOffset"].get<std::size_t>(), 4), "\x89PNG");
  }
  for (std::size_t p = 0; p < 10; ++p) {
    const Json& node = glb.json["nodes"][p + 1];
    const Json& primitive = glb.json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    const Json& material = glb.json["materials"][primitive["material"].get<std::size_t>()];
    const std::size_t texture = material["pbrMetallicRoughness"]["baseColorTexture"]["index"];
    const std::size_t image = glb.json["textures"][texture]["source"];
    EXPECT_EQ(glb.json["images"][image]["name"], node["extras"]["label"]);
    const std::size_t positions = primitive["attributes"]["POSITION"];
    const std::size_t coordinates = primitive["attributes"]["TEXCOORD_0"];
    ASSERT_EQ(glb.json["accessors"][coordinates]["count"],
              glb.json["accessors"][positions]["count"]);
    for (std::size_t i = 0; i < glb.json["accessors"][positions]["count"]; ++i) {
      Eigen::Vector2f place;
      std::memcpy(place.data(), glb.data.data() + glb.place(coordinates, i, 8), 8);
      const Eigen::Vector2d expected = frames[p].at(glb.position(positions, i).cast<double>());
      EXPECT_NEAR(place.x(), expected.x(), 1e-5);
      EXPECT_NEAR(place.y(), 1 - expected.y(), 1e-5);
    }
  }
  const Json& rest = glb.json["meshes"][glb.json["nodes"][11]["mesh"].get<std::size_t>()];
  EXPECT_FALSE(rest["primitives"][0]["attributes"].contains("TEXCOORD_0"));
}

TEST(MapGlb, RefusesWhatDoesNotMatchOrIsEmpty) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  TriangulatedMap triangles = triangulated(small.map);
  triangles.polygon.back() = 10;
  EXPECT_THROW(write_map_glb(directory / "a.glb", triangles, small.labelled()), Error);
  triangles.polygon.pop_back();
  EXPECT_THROW(write_map_glb(directory / "a.glb", triangles, small.labelled()), Error);
  EXPECT_THROW(write_map_glb(directory / "a.glb", triangulated(small.map), small.labelled(),
                             std::vector<TextureFrame>(3)),
               Error);
  const SmallMap none;
  EXPECT_THROW(write_map_glb(directory / "a.glb", {}, none.labelled()), Error);
  EXPECT_FALSE(std::filesystem::exists(directory / "a.glb"));
}

}  // namespace
}  // namespace planum
