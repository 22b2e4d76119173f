#include "slam/io/ply.hpp"

#include <algorithm>
#include <bit>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_in_text;
using testing::TemporaryDirectory;
using testing::text_of;
using testing::write_text;

Cloud random_cloud(std::size_t count, bool normals, bool intensity, bool scan) {
  testing::Draws draws(static_cast<unsigned>(count));
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.push_back(draws.vector(100).cast<float>());
    if (normals) cloud.normals.push_back(draws.vector(1).normalized().cast<float>());
    if (intensity) cloud.intensity.push_back(static_cast<float>(draws.uniform(0, 1)));
    if (scan) cloud.scan.push_back(static_cast<std::uint32_t>(draws.below(0x100000000)));
  }
  return cloud;
}

void expect_same(const Cloud& a, const Cloud& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.scan, b.scan);
}

TriangleMesh random_mesh(std::size_t vertices, std::size_t triangles) {
  testing::Draws draws(static_cast<unsigned>(vertices));
  TriangleMesh mesh;
  for (std::size_t i = 0; i < vertices; ++i)
    mesh.vertices.push_back(draws.vector(100).cast<float>());
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto corner = [&] { return static_cast<std::uint32_t>(draws.below(vertices)); };
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

template <class Value>
std::string bytes_of(Value value, bool big_endian) {
  std::string bytes(sizeof(Value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(Value));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string cloud_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "cloud.ply", text, read_ply_cloud);
}

std::string mesh_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "mesh.ply", text, read_ply_mesh);
}

const std::string ascii = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string faces = "property list uchar int vertex_indices\n";

TEST(PlyCloud, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  for (const std::size_t count : {0, 1, 100, 50'000})
    for (int attributes = 0; attributes < 8; ++attributes) {
      const Cloud cloud =
          random_cloud(count, attributes & 1, (attributes & 2) != 0, (attributes & 4) != 0);
      write_ply(directory / "cloud.ply", cloud);
      expect_same(read_ply_cloud(directory / "cloud.ply"), cloud);
    }
}

TEST(PlyCloud, IsWrittenByteForByteAsDocumented) {
  const TemporaryDirectory directory;
  Cloud cloud;
  cloud.points = {{1, 2, 3}};
  cloud.normals = {{0, 0, 1}};
  cloud.intensity = {0.5f};
  cloud.scan = {7};
  write_ply(directory / "cloud.ply", cloud);
  std::string expected =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz +
      "property float nx\nproperty float ny\nproperty float nz\nproperty float intensity\n"
      "property uint scan\nend_header\n";
  for (const float value : {1.f, 2.f, 3.f, 0.f, 0.f, 1.f, 0.5f}) expected += bytes_of(value, false);
  expected += bytes_of<std::uint32_t>(7, false);
  EXPECT_EQ(text_of(directory / "cloud.ply"), expected);
}

TEST(PlyCloud, IsReadFromTextWithAnyOrderOfProperties) {
  const TemporaryDirectory directory;
  write_text(directory / "cloud.ply",
             "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nobj_info none\r\n"
             "element camera 1\r\nproperty float view\r\n"
             "element vertex 2\r\nproperty uchar red\r\nproperty double z\r\nproperty float y\r\n"
             "property int x\r\nproperty list uchar int ring\r\nproperty float scalar_intensity\r\n"
             "property float scan\r\nend_header\r\n"
             "9.5\r\n255 3.5 2.5 1 2 8 9 0.25 4\r\n0 nan -2 -1 0 0.75 5");
  const Cloud cloud = read_ply_cloud(directory / "cloud.ply");
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1, 2.5f, 3.5f));
  EXPECT_TRUE(std::isnan(cloud.points[1].z()));
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.25f, 0.75f}));
  EXPECT_EQ(cloud.scan, (std::vector<std::uint32_t>{4, 5}));
  EXPECT_TRUE(cloud.normals.empty());
}

TEST(PlyCloud, IsReadFromBothByteOrdersAndAllTypes) {
  const TemporaryDirectory directory;
  for (const bool big : {false, true})
    for (const bool with_list : {false, true}) {
      std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                         "_endian 1.0\nelement vertex 2\nproperty double x\nproperty int16 y\n" +
                         (with_list ? "property list ushort float64 skipped\n" : "") +
                         "property char z\nproperty uchar intensity\nproperty ushort scan\n"
                         "end_header\n";
      for (const int i : {1, 2}) {
        text += bytes_of(i * 1.5, big) + bytes_of(static_cast<std::int16_t>(-300 * i), big);
        if (with_list)
          text += bytes_of(static_cast<std::uint16_t>(i), big) + std::string(8 * i, 'x');
        text += bytes_of(static_cast<std::int8_t>(-i), big) +
                bytes_of(static_cast<std::uint8_t>(200 + i), big) +
                bytes_of(static_cast<std::uint16_t>(1000 * i), big);
      }
      write_text(directory / "cloud.ply", text);
      const Cloud cloud = read_ply_cloud(directory / "cloud.ply");
      ASSERT_EQ(cloud.points.size(), 2u);
      EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5f, -300, -1));
      EXPECT_EQ(cloud.points[1], Eigen::Vector3f(3, -600, -2));
      EXPECT_EQ(cloud.intensity, (std::vector<float>{201, 202}));
      EXPECT_EQ(cloud.scan, (std::vector<std::uint32_t>{1000, 2000}));
    }
}

TEST(PlyCloud, SaysWhatIsWrongWithItsHeader) {
  EXPECT_EQ(cloud_error(""), "FILE:1: expected a PLY file, which begins with \"ply\"");
  EXPECT_EQ(cloud_error("1 2 3\n"), "FILE:1: expected a PLY file, which begins with \"ply\"");
  EXPECT_EQ(cloud_error("ply\nformat ascii 1.0\n"),
            "FILE: the header of the PLY file has no end_header line");
  EXPECT_EQ(cloud_error("ply\nformat zip 1.0\nend_header\n"),
            "FILE:2: expected ascii, binary_little_endian or binary_big_endian, got \"zip\"");
  EXPECT_EQ(cloud_error(ascii + "element vertex many\nend_header\n"),
            "FILE:3: expected a whole number, got \"many\"");
  EXPECT_EQ(cloud_error(ascii + "element vertex -1\nend_header\n"),
            "FILE:3: there cannot be -1 rows of vertex");
  EXPECT_EQ(cloud_error(ascii + "property float x\nend_header\n"),
            "FILE:3: expected an element before its properties");
  EXPECT_EQ(cloud_error(ascii + "element vertex 1\nproperty real x\nend_header\n"),
            "FILE:4: expected a type such as float or uchar, got \"real\"");
  EXPECT_EQ(cloud_error(ascii + "elements\nend_header\n"),
            "FILE:3: expected element, property or end_header, got \"elements\"");
  EXPECT_EQ(cloud_error("ply\nelement vertex 0\nend_header\n"),
            "FILE:3: the header has no format line");
  EXPECT_EQ(cloud_error(ascii + "end_header\n"), "FILE: there is no element vertex in it");
  EXPECT_EQ(cloud_error(ascii + "element vertex 1\nproperty float x\nend_header\n1\n"),
            "FILE: its vertices have no properties x, y and z");
}

TEST(PlyCloud, SaysThatItIsTruncated) {
  EXPECT_EQ(cloud_error(ascii + "element vertex 3\n" + xyz + "end_header\n1 2 3\n4 5 6\n"),
            "FILE:9: expected 3 rows of vertex, got 2");
  EXPECT_EQ(cloud_error(ascii + "element vertex 2\n" + xyz + "end_header\n1 2 3\n4 5\n"),
            "FILE:9: expected a number, got the end of the line");
  EXPECT_EQ(cloud_error(ascii + "element vertex 2000000000000\n" + xyz + "end_header\n1 2 3\n"),
            "FILE:7: the file is too short for 2000000000000 rows of vertex");
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  EXPECT_EQ(
      cloud_error(binary + "element vertex 2\n" + xyz + "end_header\n" + std::string(23, 'x')),
      "FILE: the file is too short for 2 rows of vertex");
  EXPECT_EQ(cloud_error(binary + "element vertex 4000000000000000000\n" + xyz + "end_header\n"),
            "FILE: the file is too short for 4000000000000000000 rows of vertex");
}

TEST(PlyCloud, WantsWholeNumbersOfScans) {
  const std::string header =
      ascii + "element vertex 1\n" + xyz + "property float scan\nend_header\n";
  EXPECT_EQ(cloud_error(header + "1 2 3 4.5\n"), "FILE:9: expected an index, got 4.5");
  EXPECT_EQ(cloud_error(header + "1 2 3 -1\n"), "FILE:9: expected an index, got -1");
  EXPECT_EQ(cloud_error(header + "1 2 3 nan\n"), "FILE:9: expected an index, got nan");
}

TEST(PlyCloud, IsNotWrittenWithAttributesOfAnotherLength) {
  const TemporaryDirectory directory;
  Cloud cloud = random_cloud(5, true, false, false);
  cloud.normals.pop_back();
  EXPECT_EQ(testing::error_of([&] { write_ply(directory / "cloud.ply", cloud); }),
            "PLY: 4 values for 5 rows of \"property float nx\"");
  EXPECT_FALSE(std::filesystem::exists(directory / "cloud.ply"));
}

TEST(PlyMesh, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  for (const std::size_t count : {3, 100, 50'000}) {
    const TriangleMesh mesh = random_mesh(count, 2 * count);
    write_ply(directory / "mesh.ply", mesh);
    const TriangleMesh read = read_ply_mesh(directory / "mesh.ply");
    EXPECT_EQ(read.vertices, mesh.vertices);
    EXPECT_EQ(read.triangles, mesh.triangles);
  }
}

TEST(PlyMesh, CarriesColoursAndProperties) {
  const TemporaryDirectory directory;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  write_ply(directory / "mesh.ply", mesh,
            {.vertex_colours = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
             .triangle_colours = {{250, 251, 252}},
             .triangle_properties = {{"polygon", {-1}}, {"label", {3}}}});
  std::string expected = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" + xyz +
                         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "element face 1\n" +
                         faces +
                         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "property int polygon\nproperty int label\nend_header\n";
  for (const float v : {0.f, 0.f, 0.f}) expected += bytes_of(v, false);
  expected += "\x01\x02\x03";
  for (const float v : {1.f, 0.f, 0.f}) expected += bytes_of(v, false);
  expected += "\x04\x05\x06";
  for (const float v : {0.f, 1.f, 0.f}) expected += bytes_of(v, false);
  expected += "\x07\x08\x09\x03";
  for (const std::uint32_t v : {0, 1, 2}) expected += bytes_of(v, false);
  expected += "\xFA\xFB\xFC";
  for (const std::int32_t v : {-1, 3}) expected += bytes_of(v, false);
  EXPECT_EQ(text_of(directory / "mesh.ply"), expected);
  const TriangleMesh read = read_ply_mesh(directory / "mesh.ply");
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST(PlyMesh, IsNotWrittenWithAttributesOfAnotherLength) {
  const TemporaryDirectory directory;
  const TriangleMesh mesh = random_mesh(5, 4);
  const auto error = [&](const MeshAttributes& attributes) {
    return testing::error_of([&] { write_ply(directory / "mesh.ply", mesh, attributes); });
  };
  EXPECT_EQ(
      error({.vertex_colours = {{0, 0, 0}}, .triangle_colours = {}, .triangle_properties = {}}),
      "PLY: 1 values for 5 rows of \"property uchar red\"");
  EXPECT_EQ(error({.vertex_colours = {},
                   .triangle_colours = {},
                   .triangle_properties = {{"polygon", {1, 2}}}}),
            "PLY: 2 values for 4 rows of \"property int polygon\"");
}

TEST(PlyMesh, IsCutIntoTrianglesWherePolygonsAreLarger) {
  const TemporaryDirectory directory;
  write_text(directory / "mesh.ply", ascii + "element face 2\nproperty float quality\n" +
                                         "property list uchar uint vertex_index\n"
                                         "element vertex 4\n" +
                                         xyz +
                                         "end_header\n"
                                         "0.5 4 0 1 2 3\n0.5 3 0 1 2\n"
                                         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
  const TriangleMesh mesh = read_ply_mesh(directory / "mesh.ply");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 3u);
}

TEST(PlyMesh, SaysWhatIsWrongWithItsFaces) {
  const std::string vertices = ascii + "element vertex 3\n" + xyz;
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(mesh_error(vertices + "end_header\n" + rows), "FILE: there is no element face in it");
  EXPECT_EQ(mesh_error(vertices + "element face 1\nproperty int a\nend_header\n" + rows + "1\n"),
            "FILE: its faces have no list vertex_indices");
  const std::string header = vertices + "element face 1\n" + faces + "end_header\n" + rows;
  EXPECT_EQ(mesh_error(header + "3 0 1 3\n"),
            "FILE: face 0 has the corner 3, but there are 3 vertices");
  EXPECT_EQ(mesh_error(header + "2 0 1\n"), "FILE: face 0 has 2 corners");
  EXPECT_EQ(mesh_error(header + "3 0 1 -1\n"), "FILE:13: expected an index, got -1");
  EXPECT_EQ(mesh_error(header + "3 0 1\n"), "FILE:13: expected a number, got the end of the line");
  EXPECT_EQ(mesh_error(header), "FILE:12: expected 1 rows of face, got 0");
}

}  // namespace
}  // namespace planum
