#include "meshing/laser_shadows.hpp"

#include <gtest/gtest.h>

#include "meshing/geos_polygons.hpp"
#include "meshing/normals.hpp"
#include "meshing/plane_geometry.hpp"
#include "meshing/polygons.hpp"
#include "meshing/surface.hpp"
#include "meshing/triangulation.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "tests/meshing/scanned_scene.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using testing::add_box;
using testing::add_rectangle;
using testing::looking;
using testing::scanned;
using testing::ScannedScene;

/// Polygons by hand, turned towards the middle of the room; corners at one place are one vertex.
class MapByHand {
 public:
  explicit MapByHand(const Vector3d& shift = Vector3d::Zero()) : shift_(shift) {}

  void add(Points outer, Points hole = {}) {
    for (Points* ring : {&outer, &hole})
      for (Vector3d& p : *ring) p += shift_;
    if (area_vector(outer).dot(Vector3d(2, 1, 1) + shift_ - outer[0]) < 0)
      std::reverse(outer.begin(), outer.end());
    const Vector3d area = area_vector(outer), normal = area.normalized();
    MapPolygon polygon{{normal, normal.dot(outer[0])}, named(outer), {}, area.norm()};
    if (!hole.empty()) {
      if (area_vector(hole).dot(normal) > 0) std::reverse(hole.begin(), hole.end());
      polygon.holes.push_back(named(hole));
      polygon.area -= area_vector(hole).norm();
    }
    map_.polygons.push_back(std::move(polygon));
  }
  const PolygonMap& map() const { return map_; }

 private:
  static Vector3d area_vector(const Points& ring) {
    Vector3d area = Vector3d::Zero();
    for (std::size_t i = 0; i < ring.size(); ++i)
      area += 0.5 * (ring[i] - ring[0]).cross(ring[(i + 1) % ring.size()] - ring[0]);
    return area;
  }

  Ring named(const Points& points) {
    Ring ring;
    for (const Vector3d& p : points) {
      std::uint32_t v = 0;
      while (v < map_.vertices.size() && map_.vertices[v] != p) ++v;
      if (v == map_.vertices.size()) map_.vertices.push_back(p);
      ring.push_back(v);
    }
    return ring;
  }

  Vector3d shift_;
  PolygonMap map_;
};

/// The scanner of these tests stands near one side of a room of 4 x 3 x 2.5 m and looks across.
const std::vector<Pose> place = {looking({2, 0.4, 1.3}, 90)};

ScannedScene seen(const TriangleMesh& model) { return scanned(model, place, {.noise = 0}); }

PolygonMap filled(const PolygonMap& map, const TriangleMesh& model,
                  const ShadowParams& params = {}) {
  const ScannedScene scene = seen(model);
  return with_shadows_filled(map, scene.cloud, scene.origins, params);
}

TriangleMesh room() {
  TriangleMesh model;
  add_box(model, {0, 0, 0}, {4, 3, 2.5});
  return model;
}

/// The far wall, y = 3, with a hole of 0.8 x 0.6 m.
PolygonMap wall_with_hole() {
  MapByHand map;
  map.add({{0, 3, 0}, {4, 3, 0}, {4, 3, 2.5}, {0, 3, 2.5}},
          {{1.6, 3, 1}, {2.4, 3, 1}, {2.4, 3, 1.6}, {1.6, 3, 1.6}});
  return map.map();
}

double inferred_area(const PolygonMap& map) {
  double sum = 0;
  for (const InferredPatch& patch : map.inferred) sum += patch.shape.area;
  return sum;
}

/// What holds for every patch: it is a polygon in the plane it continues, the right way round.
void expect_laws(const PolygonMap& map) {
  for (const InferredPatch& patch : map.inferred) {
    ASSERT_LT(patch.polygon, map.polygons.size());
    EXPECT_EQ(patch.shape.plane.normal, map.polygons[patch.polygon].plane.normal);
    const PlaneFrame frame(patch.shape.plane);
    std::vector<Ring2d> rings;
    std::vector<Ring> all{patch.shape.outer};
    all.insert(all.end(), patch.shape.holes.begin(), patch.shape.holes.end());
    double area = 0;
    for (const Ring& ring : all) {
      rings.emplace_back();
      for (const std::uint32_t v : ring) {
        EXPECT_LT(std::abs(patch.shape.plane.signed_distance(map.vertices[v])), 2e-3);
        rings.back().push_back(frame.flat(map.vertices[v]));
      }
      area += signed_area(rings.back());
      EXPECT_EQ(signed_area(rings.back()) > 0, rings.size() == 1);
    }
    EXPECT_TRUE(is_valid_polygon(rings));
    EXPECT_NEAR(patch.shape.area, area, 1e-9);
  }
}

TEST(LaserShadows, FillAHoleBehindAThing) {
  TriangleMesh model = room();
  add_box(model, {1.6, 1.6, 1.0}, {2.4, 1.7, 1.6});
  const PolygonMap before = wall_with_hole(), after = filled(before, model);
  expect_laws(after);
  ASSERT_EQ(after.inferred.size(), 1u);
  EXPECT_NEAR(after.inferred[0].shape.area, 0.48, 1e-9);
  EXPECT_EQ(after.vertices.size(), before.vertices.size());
  EXPECT_EQ(after.polygons[0].area, before.polygons[0].area);
  const TriangulatedMap triangles = triangulated(after);
  double inferred = 0, seen_area = 0;
  for (std::size_t i = 0; i < triangles.mesh.triangles.size(); ++i)
    (triangles.inferred[i] ? inferred : seen_area) += testing::area_of(triangles.mesh, i);
  EXPECT_NEAR(inferred, 0.48, 1e-5);
  EXPECT_NEAR(seen_area, before.polygons[0].area, 1e-4);
}

TEST(LaserShadows, LeaveOpenWhatRaysPassOrNobodyKnows) {
  TriangleMesh window;
  add_rectangle(window, {0, 3, 0}, {4, 0, 0}, {0, 0, 1});
  add_rectangle(window, {0, 3, 1.6}, {4, 0, 0}, {0, 0, 0.9});
  add_rectangle(window, {0, 3, 1}, {1.6, 0, 0}, {0, 0, 0.6});
  add_rectangle(window, {2.4, 3, 1}, {1.6, 0, 0}, {0, 0, 0.6});
  EXPECT_TRUE(filled(wall_with_hole(), window).inferred.empty());  // no return from outside
  add_rectangle(window, {0, 6, 0}, {4, 0, 0}, {0, 0, 3});
  EXPECT_TRUE(filled(wall_with_hole(), window).inferred.empty());  // a house across the street
}

TEST(LaserShadows, AreNotToldByScansFromBehindOtherWalls) {
  TriangleMesh model;  // the window, and a wall behind the first scanner
  add_rectangle(model, {0, 3, 0}, {4, 0, 0}, {0, 0, 1});
  add_rectangle(model, {0, 3, 1.6}, {4, 0, 0}, {0, 0, 0.9});
  add_rectangle(model, {0, 3, 1}, {1.6, 0, 0}, {0, 0, 0.6});
  add_rectangle(model, {2.4, 3, 1}, {1.6, 0, 0}, {0, 0, 0.6});
  add_rectangle(model, {-2, -1, -1}, {8, 0, 0}, {0, 0, 5});
  const ScannedScene scene = scanned(model, {place[0], looking({2, -3, 1.3}, 90)}, {.noise = 0});
  EXPECT_TRUE(with_shadows_filled(wall_with_hole(), scene.cloud, scene.origins).inferred.empty());
}

TEST(LaserShadows, AreFilledUpToAGivenSize) {
  TriangleMesh model = room();
  add_box(model, {1.6, 1.6, 1.0}, {2.4, 1.7, 1.6});
  EXPECT_EQ(filled(wall_with_hole(), model, {.max_area = 0.49}).inferred.size(), 1u);
  EXPECT_TRUE(filled(wall_with_hole(), model, {.max_area = 0.47}).inferred.empty());
  EXPECT_TRUE(filled(wall_with_hole(), model, {.max_area = 0}).inferred.empty());
}

/// A chest hides a part of the floor at the far wall, and of the wall.
TEST(LaserShadows, FillNotchesUpToTheLineWherePlanesMeet) {
  MapByHand map;
  map.add({{0, 0, 0},
           {4, 0, 0},
           {4, 3, 0},
           {2.4, 3, 0},
           {2.4, 2, 0},
           {1.6, 2, 0},
           {1.6, 3, 0},
           {0, 3, 0}});
  map.add({{0, 3, 0},
           {1.6, 3, 0},
           {1.6, 3, 0.7},
           {2.4, 3, 0.7},
           {2.4, 3, 0},
           {4, 3, 0},
           {4, 3, 2.5},
           {0, 3, 2.5}});
  TriangleMesh model = room();
  add_box(model, {1.5, 1.9, 0}, {2.5, 2.9, 1.0});
  const PolygonMap after = filled(map.map(), model);
  expect_laws(after);
  ASSERT_EQ(after.inferred.size(), 2u);
  EXPECT_EQ(after.inferred[0].polygon, 0u);
  EXPECT_NEAR(after.inferred[0].shape.area, 0.8 * 1, 1e-9);
  EXPECT_EQ(after.inferred[1].polygon, 1u);
  EXPECT_NEAR(after.inferred[1].shape.area, 0.8 * 0.7, 1e-9);
  EXPECT_EQ(after.vertices.size(), map.map().vertices.size());
}

/// The wall is two polygons that are turned a little against each other; far from the origin their
/// offsets differ by metres.
TEST(LaserShadows, AreBoundedByPartsOfOneWallWhereverTheWorldBegins) {
  const Vector3d shift(800, 0, 0);
  MapByHand map(shift);
  map.add({{0, 0, 0},
           {4, 0, 0},
           {4, 3.01, 0},
           {2.4, 3, 0},
           {2.4, 2, 0},
           {1.6, 2, 0},
           {1.6, 3, 0},
           {0, 3, 0}});
  map.add({{0, 3, 0}, {1.6, 3, 0}, {1.6, 3, 2.5}, {0, 3, 2.5}});
  map.add({{2.4, 3, 0}, {4, 3.01, 0}, {4, 3.01, 2.5}, {2.4, 3, 2.5}});
  TriangleMesh model = room();
  add_box(model, {1.5, 1.9, 0}, {2.5, 2.9, 1.0});
  ScannedScene scene = seen(model);
  for (Eigen::Vector3f& p : scene.cloud.points) p += shift.cast<float>();
  for (Vector3d& origin : scene.origins) origin += shift;
  const PolygonMap after = with_shadows_filled(map.map(), scene.cloud, scene.origins);
  ASSERT_EQ(after.inferred.size(), 1u);
  EXPECT_NEAR(after.inferred[0].shape.area, 0.8 * 1, 1e-9);
}

TEST(LaserShadows, FillTheCornerOfARoomThatNobodySaw) {
  MapByHand map;
  map.add({{0, 0, 0}, {4, 0, 0}, {4, 2.2, 0}, {3.2, 2.2, 0}, {3.2, 3, 0}, {0, 3, 0}});
  map.add({{0, 3, 2.5}, {0, 3, 0}, {3.2, 3, 0}, {3.2, 3, 2.5}});
  map.add({{4, 0, 0}, {4, 0, 2.5}, {4, 2.2, 2.5}, {4, 2.2, 0}});
  TriangleMesh model = room();
  add_box(model, {3.1, 2.1, 0}, {3.95, 2.95, 2.4});
  const PolygonMap after = filled(map.map(), model);
  expect_laws(after);
  ASSERT_EQ(after.inferred.size(), 1u);
  EXPECT_NEAR(after.inferred[0].shape.area, 0.64, 1e-9);
  ASSERT_EQ(after.vertices.size(), map.map().vertices.size() + 1);
  EXPECT_LT((after.vertices.back() - Vector3d(4, 3, 0)).norm(), 1e-9);
}

PolygonMap map_of(const ScannedScene& scene) {
  Cloud cloud = scene.cloud;
  cloud.normals = estimate_normals(cloud, scene.origins);
  const TriangleMesh mesh = reconstruct(cloud);
  const PolygonMap map =
      polygonize(mesh, grow_planes(mesh, cloud, region_params(0.05)), polygon_params(0.05));
  return with_shadows_filled(map, cloud, scene.origins);
}

/// From scans to patches, with the truth at hand: a room whose box hides floor and walls.
TEST(LaserShadows, OfAScannedRoomLieOnItsSurfaces) {
  const TriangleMesh model = testing::room_with_box();
  const ScannedScene scene =
      scanned(model, {looking({0.6, 1.6, 0.9}, 0), looking({0.7, 3.2, 1.0}, -50)});
  const PolygonMap map = map_of(scene);
  expect_laws(map);
  EXPECT_GT(inferred_area(map), 0.3);
  const TriangulatedMap triangles = triangulated(map);
  for (std::size_t i = 0; i < triangles.mesh.triangles.size(); ++i) {
    if (!triangles.inferred[i]) continue;
    const auto& [a, b, c] = triangles.mesh.triangles[i];
    const auto& v = triangles.mesh.vertices;
    EXPECT_LT(testing::distance_to(model, (v[a] + v[b] + v[c]) / 3), 0.03);
  }
}

TEST(LaserShadows, AreTheSameForAnyNumberOfThreads) {
  const ScannedScene scene = scanned(testing::room_with_box(), {looking({0.6, 1.6, 0.9}, 0)});
  set_thread_count(1);
  const PolygonMap one = map_of(scene);
  set_thread_count(3);
  const PolygonMap three = map_of(scene);
  set_thread_count(0);
  EXPECT_EQ(one.vertices, three.vertices);
  ASSERT_EQ(one.inferred.size(), three.inferred.size());
  for (std::size_t i = 0; i < one.inferred.size(); ++i)
    EXPECT_EQ(one.inferred[i].shape.outer, three.inferred[i].shape.outer);
}

TEST(LaserShadows, RefuseWhatCannotBe) {
  Cloud cloud;
  cloud.points = {{0, 0, 0}, {1, 0, 0}};
  cloud.scan = {0, 3};
  const std::vector<Vector3d> origins(2, Vector3d::UnitZ());
  EXPECT_THROW(with_shadows_filled({}, cloud, origins), Error);
  cloud.scan = {0, 1};
  EXPECT_TRUE(with_shadows_filled({}, cloud, origins).inferred.empty());
  EXPECT_THROW(with_shadows_filled({}, cloud, origins, {.max_area = -1}), Error);
  EXPECT_THROW(with_shadows_filled({}, cloud, origins, {.sample = 0}), Error);
}

}  // namespace
}  // namespace planum
