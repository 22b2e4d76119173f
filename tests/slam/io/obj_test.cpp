#include "slam/io/obj.hpp"

#include <set>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::write_text;

LabelledMesh mesh_from(const std::string& text) {
  const TemporaryDirectory directory;
  write_text(directory / "building.obj", text);
  return read_obj(directory / "building.obj");
}

std::string error_from(const std::string& text) {
  const TemporaryDirectory directory;
  return testing::error_in_text(directory / "building.obj", text, read_obj);
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, ReadsGroupsAndEveryFormOfIndex) {
  const LabelledMesh read = mesh_from(
      "# a building\nmtllib a.mtl\no thing\n" + square +
      "vt 0 0\nvn 0 0 1\nf 1 2 3\nusemtl wall, old\r\nf 1/1 3/1 4/1\nusemtl floor\ns off\n"
      "f -4//1 -3//1 -2//1\nusemtl wall, old\nf 1/1/1 2/1/1 4/1/1 # last\n");
  EXPECT_EQ(read.names, (std::vector<std::string>{"default", "wall, old", "floor"}));
  EXPECT_EQ(read.group, (std::vector<std::uint32_t>{0, 1, 2, 1}));
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_EQ(read.mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 3}}));
  EXPECT_EQ(read.mesh.vertices[2], Eigen::Vector3f(1, 1, 0));
}

TEST(Obj, GivesTheTrianglesOfALargerFaceItsGroup) {
  const LabelledMesh read = mesh_from(square + "usemtl wall\nf 1 2 3 4\n");
  EXPECT_EQ(read.mesh.triangles.size(), 2u);
  EXPECT_EQ(read.group, (std::vector<std::uint32_t>{0, 0}));
}

TEST(Obj, SaysWhereALineIsWrong) {
  EXPECT_EQ(error_from("v 1 2\n"), "FILE:1: expected 3 numbers after v, got 2");
  EXPECT_EQ(error_from("v 1 2 z\n"), "FILE:1: expected a number, got \"z\"");
  EXPECT_EQ(error_from(square + "f 1 2 5\n"), "FILE:5: there is no vertex 5, there are 4 so far");
  EXPECT_EQ(error_from(square + "f 0 1 2\n"), "FILE:5: there is no vertex 0, there are 4 so far");
  EXPECT_EQ(error_from(square + "f -5 1 2\n"), "FILE:5: there is no vertex -5, there are 4 so far");
  EXPECT_EQ(error_from(square + "f 1 2\n"), "FILE:5: expected at least 3 corners, got 2");
  EXPECT_EQ(error_from(square + "f 1 2 a\n"), "FILE:5: expected a vertex index, got \"a\"");
  EXPECT_EQ(error_from(square + "f 1 2 3.5\n"), "FILE:5: expected a vertex index, got \"3.5\"");
  EXPECT_EQ(error_from(square), "FILE: there are no faces in it");
  EXPECT_EQ(error_from(""), "FILE: there are no faces in it");
}

TEST(Obj, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(7);
  LabelledMesh written;
  written.names = {"floor", "wall with a long name", "ceiling"};
  for (int i = 0; i < 500; ++i) written.mesh.vertices.push_back(draws.vector(50).cast<float>());
  for (int i = 0; i < 1000; ++i) {
    const auto corner = [&] { return static_cast<std::uint32_t>(draws.below(500)); };
    written.mesh.triangles.push_back({corner(), corner(), corner()});
    // Names come back in the order of their first use.
    written.group.push_back(i < 3 ? static_cast<std::uint32_t>(i)
                                  : static_cast<std::uint32_t>(draws.below(3)));
  }
  write_obj(directory / "map.obj", written, {.material_library = "map.mtl"});
  EXPECT_TRUE(testing::text_of(directory / "map.obj").starts_with("mtllib map.mtl\nv "));
  const LabelledMesh read = read_obj(directory / "map.obj");
  EXPECT_EQ(read.mesh.vertices, written.mesh.vertices);
  EXPECT_EQ(read.mesh.triangles, written.mesh.triangles);
  EXPECT_EQ(read.names, written.names);
  EXPECT_EQ(read.group, written.group);
}

TEST(Obj, HasTextureCoordinatesWhereThereAreSome) {
  const TemporaryDirectory directory;
  const LabelledMesh mesh = mesh_from(square + "f 1 2 3\nf 1 3 4\n");
  TextureCoordinates texture;
  texture.places = {{0, 0}, {0.5f, 0}, {0.5f, -1.25f}};
  constexpr std::uint32_t none = TextureCoordinates::none;
  texture.corners = {{0, 1, 2}, {none, none, none}};
  write_obj(directory / "map.obj", mesh, {.texture = texture});
  const std::string text = testing::text_of(directory / "map.obj");
  EXPECT_NE(text.find("vt 0.0000 0.0000\nvt 0.5000 0.0000\nvt 0.5000 -1.2500\n"),
            std::string::npos);
  EXPECT_NE(text.find("f 1/1 2/2 3/3\nf 1 3 4\n"), std::string::npos);
  EXPECT_EQ(read_obj(directory / "map.obj").mesh.triangles, mesh.mesh.triangles);

  texture.corners[0][1] = 3;
  EXPECT_NE(testing::error_of([&] { write_obj(directory / "b.obj", mesh, {.texture = texture}); }),
            "");
  texture.corners.pop_back();
  EXPECT_NE(testing::error_of([&] { write_obj(directory / "b.obj", mesh, {.texture = texture}); }),
            "");
  EXPECT_FALSE(std::filesystem::exists(directory / "b.obj"));
}

TEST(Obj, IsNotWrittenWithNamesThatWouldNotComeBack) {
  const TemporaryDirectory directory;
  LabelledMesh mesh = mesh_from(square + "f 1 2 3\n");
  for (const std::string name : {"", "two\nlines", " wall", "wall "}) {
    mesh.names = {name};
    EXPECT_NE(testing::error_of([&] { write_obj(directory / "map.obj", mesh); }), "") << name;
  }
  mesh.names = {"wall"};
  mesh.group = {1};
  EXPECT_NE(testing::error_of([&] { write_obj(directory / "map.obj", mesh); }), "");
  mesh.group = {};
  EXPECT_NE(testing::error_of([&] { write_obj(directory / "map.obj", mesh); }), "");
  EXPECT_FALSE(std::filesystem::exists(directory / "map.obj"));
}

TEST(Obj, ReadsTheSharedBuildings) {
  PLANUM_SHARED_DATASET(classroom, "classroom");
  const LabelledMesh read = read_obj(classroom / "building.obj");
  EXPECT_EQ(std::set<std::string>(read.names.begin(), read.names.end()),
            (std::set<std::string>{"jamb", "floor", "lintel", "ceiling", "wall", "clutter"}));
  EXPECT_EQ(read.mesh.triangles.size(), 2 * 59u);
  PLANUM_SHARED_DATASET(house, "small_house");
  EXPECT_GT(read_obj(house / "small_house_labelled.obj").mesh.triangles.size(), 100'000u);
}

}  // namespace
}  // namespace planum
