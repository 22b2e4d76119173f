#include "tools/maps/map_mesh.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "tests/meshing/scenes.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"
#include "tools/maps/label_colours.hpp"
#include "tools/maps/label_textures.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using testing::small_map;
using testing::SmallMap;
using testing::TemporaryDirectory;

/// A row of `face` in map.ply, as docs/formats.md has it.
struct Face {
  std::array<std::int32_t, 3> corners;
  Colour colour;
  std::int32_t label, polygon, inferred;
};

/// map.ply by docs/formats.md alone, without the reader of the library.
std::vector<Face> faces_of_ply(const std::filesystem::path& path, std::size_t vertices,
                               std::size_t faces) {
  const std::string text = testing::text_of(path);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(faces) +
      "\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nproperty int label\nproperty int polygon\n"
      "property int inferred\nend_header\n";
  EXPECT_EQ(text.substr(0, header.size()), header);
  constexpr std::size_t row = 1 + 12 + 3 + 4 + 4 + 4;
  EXPECT_EQ(text.size(), header.size() + 12 * vertices + row * faces);
  if (::testing::Test::HasFailure()) return {};
  std::vector<Face> result(faces);
  const char* at = text.data() + header.size() + 12 * vertices;
  for (Face& face : result) {
    EXPECT_EQ(*at, 3);
    std::memcpy(face.corners.data(), at + 1, 12);
    std::memcpy(face.colour.data(), at + 13, 3);
    std::memcpy(&face.label, at + 16, 4);
    std::memcpy(&face.polygon, at + 20, 4);
    std::memcpy(&face.inferred, at + 24, 4);
    at += row;
  }
  return result;
}

double area_of(const TriangleMesh& mesh, std::size_t i) {
  const auto& t = mesh.triangles[i];
  const Eigen::Vector3f a = mesh.vertices[t[1]] - mesh.vertices[t[0]];
  const Eigen::Vector3f b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
  return a.cross(b).norm() / 2;
}

TEST(MapMesh, PlyHasTheAreaOfEveryPolygonUnderItsLabel) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map(testing::some_pose(1));
  const TriangulatedMap triangles = triangulated(small.map);
  write_map_ply(directory / "map.ply", triangles, small.labels);
  const TriangleMesh mesh = read_ply_mesh(directory / "map.ply");
  // Of the floor with its hole, of nine rectangles, and of the top of the box.
  const std::vector<Face> faces = faces_of_ply(directory / "map.ply", 16, 8 + 9 * 2 + 2);
  ASSERT_EQ(faces.size(), mesh.triangles.size());
  std::map<std::int32_t, double> area;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    for (const std::size_t k : {0, 1, 2})
      EXPECT_EQ(static_cast<std::uint32_t>(face.corners[k]), mesh.triangles[i][k]);
    area[face.polygon] += area_of(mesh, i);
    EXPECT_EQ(face.inferred, 0);
    if (face.polygon < 0) {
      EXPECT_EQ(face.polygon, -1);
      EXPECT_EQ(face.label, -1);
      EXPECT_EQ(face.colour, colour_of_rest());
      continue;
    }
    ASSERT_LT(face.polygon, 10);
    const Label label = small.labels.polygons[static_cast<std::size_t>(face.polygon)].label;
    EXPECT_EQ(face.label, static_cast<int>(label));
    EXPECT_EQ(face.colour, colour_of(label));
  }
  ASSERT_EQ(area.size(), 11u);
  EXPECT_NEAR(area[-1], 0.8, 1e-4);
  for (int id = 0; id < 10; ++id)
    EXPECT_NEAR(area[id], small.map.polygons[static_cast<std::size_t>(id)].area, 1e-4) << id;
}

TEST(MapMesh, PlyIsOneClosedSurfaceAroundFreeSpace) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  write_map_ply(directory / "map.ply", triangulated(small.map), small.labels);
  const TriangleMesh mesh = read_ply_mesh(directory / "map.ply");
  EXPECT_EQ(testing::open_edges(mesh), 0u);
  EXPECT_NEAR(testing::signed_volume(mesh), -testing::small_map_volume, 1e-4);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& v : mesh.vertices) box.extend(v);
  EXPECT_EQ(box.min(), Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(box.max(), Eigen::Vector3f(4, 3, 2.5f));
}

/// The `Kd` of each `newmtl` of a material library.
std::map<std::string, Vector3d> materials_in(const std::filesystem::path& path) {
  std::map<std::string, Vector3d> found;
  std::istringstream lines(testing::text_of(path));
  std::string line, material;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "newmtl") {
      EXPECT_TRUE(words >> material) << line;
      EXPECT_FALSE(found.contains(material)) << material << " is there twice";
      found[material].setConstant(-1);
    } else if (key == "Kd") {
      Vector3d& colour = found[material];
      EXPECT_TRUE(words >> colour.x() >> colour.y() >> colour.z()) << line;
    }
  }
  return found;
}

TEST(MapMesh, PlyMarksFilledShadowsWithTheLabelOfTheirPlane) {
  const TemporaryDirectory directory;
  SmallMap small = small_map();
  MapPolygon shape = small.map.polygons[1];
  shape.outer.pop_back();
  small.map.inferred = {{.polygon = 1, .shape = shape}};
  write_map_ply(directory / "map.ply", triangulated(small.map), small.labels);
  const std::vector<Face> faces = faces_of_ply(directory / "map.ply", 16, 8 + 9 * 2 + 2 + 1);
  ASSERT_EQ(faces.size(), 29u);
  EXPECT_EQ(faces.back().inferred, 1);
  EXPECT_EQ(faces.back().polygon, 1);
  EXPECT_EQ(faces.back().label, static_cast<int>(small.labels.polygons[1].label));
  EXPECT_EQ(faces[27].inferred, 0);
}

TEST(MapMesh, ObjSaysTheSameAsPly) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map(testing::some_pose(2));
  const TriangulatedMap triangles = triangulated(small.map);
  write_map_ply(directory / "map.ply", triangles, small.labels);
  write_map_obj(directory / "map.obj", triangles, small.labels);
  const TriangleMesh ply = read_ply_mesh(directory / "map.ply");
  const std::vector<Face> faces =
      faces_of_ply(directory / "map.ply", ply.vertices.size(), ply.triangles.size());
  const LabelledMesh obj = read_obj(directory / "map.obj");
  EXPECT_EQ(obj.mesh.vertices, ply.vertices);
  EXPECT_EQ(obj.mesh.triangles, ply.triangles);
  ASSERT_EQ(obj.group.size(), faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    EXPECT_EQ(obj.names[obj.group[i]],
              faces[i].label < 0 ? "rest" : name(static_cast<Label>(faces[i].label)));
}

TEST(MapMesh, ObjFindsEveryMaterialInTheLibraryBesideIt) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  write_map_obj(directory / "some.map.obj", triangulated(small.map), small.labels);
  EXPECT_TRUE(testing::text_of(directory / "some.map.obj").starts_with("mtllib some.map.mtl\nv "));
  const auto materials = materials_in(directory / "some.map.mtl");
  EXPECT_EQ(materials.size(), all_labels.size() + 1);
  const LabelledMesh obj = read_obj(directory / "some.map.obj");
  EXPECT_EQ(std::set(obj.names.begin(), obj.names.end()),
            (std::set<std::string>{"floor", "ceiling", "wall", "unknown", "rest"}));
  for (const std::string& used : obj.names) EXPECT_TRUE(materials.contains(used)) << used;
  const auto expect_colour = [&](const std::string& material, const Colour& colour) {
    for (const int k : {0, 1, 2})
      EXPECT_NEAR(255 * materials.at(material)[k], colour[static_cast<std::size_t>(k)], 0.1)
          << material;
  };
  for (const Label label : all_labels) expect_colour(name(label), colour_of(label));
  expect_colour("rest", colour_of_rest());
}

TEST(MapMesh, ObjHasTexturesOfTheirRealSize) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map(testing::some_pose(3));
  const TriangulatedMap triangles = triangulated(small.map);
  write_map_obj(directory / "map.obj", triangles, small.labels,
                texture_frames(small.map, small.labels));
  const std::string materials = testing::text_of(directory / "map.mtl");
  for (const Label label : all_labels) {
    const std::string picture = std::string("textures/") + name(label) + ".png";
    EXPECT_NE(materials.find("map_Kd " + picture + "\n"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(directory / picture));
  }
  // The area of a triangle in its picture is that in the map.
  std::istringstream lines(testing::text_of(directory / "map.obj"));
  std::vector<Eigen::Vector2d> places;
  std::size_t triangle = 0;
  for (std::string word; lines >> word;) {
    if (word == "vt") {
      Eigen::Vector2d& place = places.emplace_back();
      lines >> place.x() >> place.y();
    } else if (word == "f") {
      std::array<std::string, 3> corners;
      for (std::string& corner : corners) lines >> corner;
      const std::uint32_t polygon = triangles.polygon[triangle++];
      if (polygon == TriangulatedMap::rest) {
        EXPECT_EQ(corners[0].find('/'), std::string::npos);
        continue;
      }
      std::array<Eigen::Vector2d, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = places.at(std::stoul(corners[k].substr(corners[k].find('/') + 1)) - 1);
      const Eigen::Vector2d a = p[1] - p[0], b = p[2] - p[0];
      const double size = texture_size(small.labels.polygons[polygon].label);
      EXPECT_NEAR(std::abs(a.x() * b.y() - a.y() * b.x()) / 2 * size * size,
                  area_of(triangles.mesh, triangle - 1), 2e-3);
    }
  }
  EXPECT_EQ(triangle, triangles.mesh.triangles.size());
  const LabelledMesh read = read_obj(directory / "map.obj");
  EXPECT_EQ(read.mesh.triangles, triangles.mesh.triangles);
}

TEST(MapMesh, ObjRefusesTexturesOfAnotherMap) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  EXPECT_EQ(testing::error_of([&] {
              write_map_obj(directory / "map.obj", triangulated(small.map), small.labels,
                            std::vector<TextureFrame>(3));
            }),
            "map: 10 polygons have a label, 3 have a texture");
}

TEST(MapMesh, ColoursTellLabelsApart) {
  std::set<Colour> colours = {colour_of_rest()};
  for (const Label label : all_labels) colours.insert(colour_of(label));
  EXPECT_EQ(colours.size(), all_labels.size() + 1);
}

using Writer = void (*)(const std::filesystem::path&, const TriangulatedMap&, const Labels&);
constexpr std::array<Writer, 2> writers = {
    write_map_ply, [](const std::filesystem::path& path, const TriangulatedMap& mesh,
                      const Labels& labels) { write_map_obj(path, mesh, labels); }};

TEST(MapMesh, SaysWhenLabelsAreOfAnotherMap) {
  const TemporaryDirectory directory;
  SmallMap small = small_map();
  small.labels.polygons.resize(9);
  const TriangulatedMap triangles = triangulated(small.map);
  for (const Writer write : writers)
    EXPECT_EQ(testing::error_of([&] { write(directory / "map.obj", triangles, small.labels); }),
              "map: triangle 24 is of polygon 9, but there are 9 labels");
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(MapMesh, SaysWhenTrianglesHaveNoPolygon) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  for (const std::size_t count : {0, 27}) {
    TriangulatedMap triangles = triangulated(small.map);
    triangles.polygon.resize(count);
    for (const Writer write : writers)
      EXPECT_EQ(testing::error_of([&] { write(directory / "map.obj", triangles, small.labels); }),
                "map: 28 triangles, but " + std::to_string(count) + " of them are of a polygon");
  }
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(MapMesh, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  const TriangulatedMap triangles = triangulated(small.map);
  for (const Writer write : writers) {
    try {
      write(directory.path() / "absent" / "map.obj", triangles, small.labels);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::environment);
      EXPECT_TRUE(std::string(error.what()).starts_with((directory / "absent/map.").string()))
          << error.what();
    }
  }
}

}  // namespace
}  // namespace planum
