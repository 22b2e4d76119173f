#include "tools/maps/sdf_world.hpp"

#include <filesystem>
#include <sdf/Collision.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Mesh.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#include <sdf/Visual.hh>
#include <sdf/World.hh>
#include <sdf/parser.hh>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/io/obj.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"

namespace planum {
namespace {

using testing::error_of;
using testing::small_map;
using testing::SmallMap;
using testing::TemporaryDirectory;

/// The building in a world as libsdformat loads it, without any complaint.
class LoadedWorld {
 public:
  explicit LoadedWorld(const std::filesystem::path& path) {
    for (const sdf::Error& error : root_.Load(path.string())) ADD_FAILURE() << error;
    EXPECT_TRUE(sdf::recursiveSiblingUniqueNames(root_.Element()));
  }

  const sdf::World& world() const { return *root_.WorldByIndex(0); }
  const sdf::Model& building() const { return *world().ModelByName("building"); }

 private:
  sdf::Root root_;
};

/// The file that a geometry names, beside the world it is in.
std::filesystem::path mesh_file(const sdf::Geometry& geometry) {
  EXPECT_EQ(geometry.Type(), sdf::GeometryType::MESH);
  const sdf::Mesh& mesh = *geometry.MeshShape();
  return std::filesystem::path(mesh.FilePath()).parent_path() / mesh.Uri();
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * static_cast<double>((mesh.vertices[b] - mesh.vertices[a])
                                         .cross(mesh.vertices[c] - mesh.vertices[a])
                                         .norm());
  return sum;
}

TEST(SdfWorld, HasALinkForEachLabelWhoseMeshesAreThere) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map();
  const TriangulatedMap mesh = triangulated(small.map);
  write_sdf_world(directory / "world" / "world.sdf", mesh, small.labelled());
  const LoadedWorld loaded(directory / "world" / "world.sdf");
  const sdf::Model& building = loaded.building();
  EXPECT_TRUE(building.Static());
  ASSERT_EQ(building.LinkCount(), 5u);
  std::set<std::string> names;
  double sum = 0;
  for (std::uint64_t i = 0; i < building.LinkCount(); ++i) {
    const sdf::Link& link = *building.LinkByIndex(i);
    names.insert(link.Name());
    ASSERT_EQ(link.VisualCount(), 1u);
    EXPECT_EQ(link.VisualByIndex(0)->Name(), link.Name() + "_visual");
    ASSERT_EQ(link.CollisionCount(), 1u);
    const auto file = mesh_file(*link.VisualByIndex(0)->Geom());
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_EQ(file, mesh_file(*link.CollisionByIndex(0)->Geom()));
    sum += area(read_obj(file).mesh);
  }
  EXPECT_EQ(names, (std::set<std::string>{"unknown", "floor", "ceiling", "wall", "rest"}));
  EXPECT_NEAR(sum, area(mesh.mesh), 1e-3);
  EXPECT_LT(loaded.world().Gravity().Z(), -9);
  EXPECT_EQ(loaded.world().LightCount(), 1u);
}

TEST(SdfWorld, HasGroundAtTheLowestFloor) {
  const TemporaryDirectory directory;
  const SmallMap small = small_map(Pose(Eigen::Translation3d(1, 2, -3)));
  write_sdf_world(directory / "world.sdf", triangulated(small.map), small.labelled());
  const LoadedWorld loaded(directory / "world.sdf");
  const sdf::Model& ground = *loaded.world().ModelByName("ground");
  EXPECT_TRUE(ground.Static());
  EXPECT_NEAR(ground.RawPose().Pos().Z(), -3, 1e-3);
  EXPECT_EQ(ground.LinkByIndex(0)->VisualCount(), 0u);
}

TEST(SdfWorld, RefusesWhatDoesNotMatchOrIsEmpty) {
  const TemporaryDirectory directory;
  const auto path = directory / "world.sdf";
  const SmallMap small = small_map(), none;
  TriangulatedMap mesh = triangulated(small.map);
  EXPECT_EQ(error_of([&] { write_sdf_world(path, {}, none.labelled()); }),
            path.string() + ": there is no triangle for it");
  mesh.polygon.back() = 10;
  EXPECT_EQ(error_of([&] { write_sdf_world(path, mesh, small.labelled()); }),
            path.string() + ": a triangle is of polygon 10 of 10");
  mesh.polygon.pop_back();
  EXPECT_THROW(write_sdf_world(path, mesh, small.labelled()), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace planum
