#include "tools/maps/objects_obj.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/obj.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/maps/object_json.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;

/// A box that is nothing known, then two models.
std::vector<SceneObject> three_objects() {
  std::vector<SceneObject> objects(3);
  for (SceneObject& object : objects) object.box.size = {1.2, 0.6, 0.74};
  const TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1f}}, {{0, 1, 2}}};
  objects[1].model =
      ModelMatch{"table", Pose(Eigen::Translation3d(1, 2, 0)), {1, 1, 1}, 0.9, 0.7, triangle};
  objects[2].model = ModelMatch{"office chair", Pose::Identity(), {1, 1, 1}, 0.8, 0.9, triangle};
  objects[2].polygons = {3, 5};
  return objects;
}

TEST(ObjectsObj, HasAGroupForEachModel) {
  const TemporaryDirectory directory;
  const auto objects = three_objects();
  write_objects_obj(directory / "objects.obj", objects);
  const LabelledMesh back = read_obj(directory / "objects.obj");
  ASSERT_EQ(back.mesh.triangles.size(), 2u);
  EXPECT_EQ(back.mesh.triangles[1], (std::array<std::uint32_t, 3>{3, 4, 5}));
  EXPECT_EQ(back.mesh.vertices[5], objects[2].model->surface.vertices[2]);
  const std::string text = testing::text_of(directory / "objects.obj");
  EXPECT_NE(text.find("g object_1_table\n"), std::string::npos);
  EXPECT_NE(text.find("g object_2_office_chair\n"), std::string::npos);
}

TEST(ObjectsObj, RefusesToBeEmpty) {
  const TemporaryDirectory directory;
  EXPECT_THROW(write_objects_obj(directory / "objects.obj", {}), Error);
}

TEST(ObjectsJson, HasBoxesRoomsAndModels) {
  RoomMap rooms;
  rooms.rooms.resize(1);
  rooms.rooms[0].name = "room 1";
  const auto json = objects_json(three_objects(), rooms);
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["room"], "room 1");
  EXPECT_TRUE(json[0]["model"].is_null());
  EXPECT_EQ(json[1]["id"], 1);
  EXPECT_EQ(json[1]["size_m"][2], 0.74);
  EXPECT_EQ(json[1]["model"]["name"], "table");
  EXPECT_EQ(json[1]["model"]["score"], 0.7);
  EXPECT_EQ(json[1]["model"]["position"][1], 2.0);
  EXPECT_EQ(json[2]["polygons"], (std::vector<int>{3, 5}));
}

}  // namespace
}  // namespace planum
