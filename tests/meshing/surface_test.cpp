#include "meshing/surface.hpp"

#include <random>

#include <gtest/gtest.h>

#include "meshing/normals.hpp"
#include "scanned_scene.hpp"
#include "slam/core/error.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/parallel.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/slices.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::add_box;
using testing::add_rectangle;
using testing::distance_to;
using testing::looking;
using testing::scanned;
using testing::ScannedScene;
using testing::topology_of;

Cloud with_normals(const ScannedScene& scene) {
  Cloud cloud = scene.cloud;
  cloud.normals = estimate_normals(cloud, scene.origins);
  return cloud;
}

/// Distances (m) of every n-th vertex to the true surface.
struct Deviation {
  double mean = 0, p99 = 0;
};
Deviation deviation_of(const TriangleMesh& mesh, const TriangleMesh& model, std::size_t step) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += step)
    distances.push_back(distance_to(model, mesh.vertices[i]));
  std::sort(distances.begin(), distances.end());
  double sum = 0;
  for (const double d : distances) sum += d;
  return {sum / double(distances.size()), distances[distances.size() * 99 / 100]};
}

/// The share of points within 2 cm of the mesh, by its vertices and the middles of its triangles.
double covered(const TriangleMesh& mesh, const Cloud& clean, std::size_t step) {
  std::vector<Vector3f> places = mesh.vertices;
  for (const auto& t : mesh.triangles)
    places.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  const KdTree tree(places);
  std::size_t near = 0, all = 0;
  for (std::size_t i = 0; i < clean.points.size(); i += step) {
    ++all;
    near += tree.nearest(clean.points[i], 0.035f).has_value();
  }
  return double(near) / double(all);
}

std::string message_of(const Cloud& cloud, const SurfaceParams& params = {}) {
  try {
    reconstruct(cloud, params);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// Random points on a sphere seen from outside.
Cloud sphere(double radius, std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 1);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d n = Vector3d(normal(random), normal(random), normal(random)).normalized();
    cloud.points.push_back((Vector3d(0.3, 0.4, 0.1) + radius * n).cast<float>());
    cloud.normals.push_back(n.cast<float>());
  }
  return cloud;
}

TEST(Surface, ClosesASphere) {
  const double radius = 0.8;
  const TriangleMesh mesh = reconstruct(sphere(radius, 60000));
  const auto topology = topology_of(mesh);
  EXPECT_EQ(topology.boundary_edges, 0u);
  EXPECT_EQ(topology.crowded_edges, 0u);
  EXPECT_EQ(topology.twisted_edges, 0u);
  EXPECT_EQ(topology.components, 1u);
  EXPECT_NEAR(testing::volume_of(mesh), 4.0 / 3 * pi * std::pow(radius, 3), 0.02);
}

TEST(Surface, OfARoomLiesOnItsWallsAndFacesItsInside) {
  const TriangleMesh model = testing::room_with_box();
  const ScannedScene scene = scanned(model, testing::room_poses());
  const TriangleMesh mesh = reconstruct(with_normals(scene));
  const Deviation deviation = deviation_of(mesh, model, 7);
  RecordProperty("mean_mm", std::to_string(1000 * deviation.mean));
  EXPECT_LT(deviation.mean, 0.002);
  EXPECT_LT(deviation.p99, 0.015);
  const auto topology = topology_of(mesh);
  EXPECT_EQ(topology.crowded_edges, 0u);
  EXPECT_EQ(topology.twisted_edges, 0u);
  // Seen from inside, walls go round the room the other way; the top of the box was seen as well.
  EXPECT_LT(testing::volume_of(mesh), -0.9 * (5 * 4 * 2.5));
  EXPECT_GT(covered(mesh, scanned(model, testing::room_poses(), {.noise = 0}).cloud, 37), 0.99);
}

TEST(Surface, OfABoxSeenFromOutsideIsClosed) {
  TriangleMesh model;
  add_box(model, {-0.52, -0.41, -0.33}, {0.52, 0.41, 0.33});
  std::vector<Pose> poses;
  for (int k = 0; k < 4; ++k)
    for (const double height : {-0.9, 0.9}) {
      const Vector3d from(2 * std::cos(k * pi / 2 + 0.4), 2 * std::sin(k * pi / 2 + 0.4), height);
      poses.push_back(looking(from, 180 + k * 90 + degrees(0.4)));
    }
  const TriangleMesh mesh = reconstruct(with_normals(
      scanned(model, poses, {.beams = 541, .slices = 250, .lowest = -45, .highest = 45})));
  const auto topology = topology_of(mesh);
  EXPECT_EQ(topology.crowded_edges, 0u);
  EXPECT_LT(double(topology.boundary_edges), 0.01 * double(mesh.triangles.size()));
  EXPECT_NEAR(testing::volume_of(mesh), 1.04 * 0.82 * 0.66, 0.02);
}

TEST(Surface, OfASinglePlaneEndsAboutAVoxelBehindTheData) {
  TriangleMesh model;
  add_rectangle(model, {2, -1, -1}, {0, 2, 0}, {0, 0, 2});
  const TriangleMesh mesh = reconstruct(with_normals(scanned(model, {looking({0, 0, 0}, 0)})));
  EXPECT_EQ(topology_of(mesh).components, 1u);
  float lowest = 0, highest = 0;
  for (const Vector3f& v : mesh.vertices) {
    EXPECT_NEAR(v.x(), 2, 0.02);
    lowest = std::min(lowest, v.tail<2>().minCoeff());
    highest = std::max(highest, v.tail<2>().maxCoeff());
  }
  EXPECT_NEAR(lowest, -1, 0.05);
  EXPECT_NEAR(highest, 1, 0.05);
}

TEST(Surface, OfAThinWallHasTwoSides) {
  for (const double thickness : {0.10, 0.15}) {
    TriangleMesh model;
    add_box(model, {-3, -2, -1}, {0, 2, 1.5});
    add_box(model, {thickness, -2, -1}, {3, 2, 1.5});
    const ScannedScene scene =
        scanned(model, {looking({-2, 0, 0}, 0), looking({2, 0.3, 0.2}, 180),
                        looking({-1, -1.7, 0}, 80), looking({1, -1.6, 0}, 100)});
    const TriangleMesh mesh = reconstruct(with_normals(scene));
    for (const Vector3f& v : mesh.vertices) {
      if (std::abs(double(v.x()) - thickness / 2) > 0.3 || std::abs(v.y()) > 1.9f) continue;
      if (v.z() < -0.9f || v.z() > 1.4f) continue;
      EXPECT_LT(std::min(std::abs(double(v.x())), std::abs(double(v.x()) - thickness)), 0.012);
    }
    EXPECT_LT(deviation_of(mesh, model, 5).mean, 0.003);
  }
}

TEST(Surface, HasNoPhantomBetweenTwoLayersThatFaceTheSameWay) {
  // A board in front of a wall, seen from one side: its back is unknown.
  for (const double gap : {0.06, 0.08, 0.1, 0.12, 0.2}) {
    TriangleMesh model;
    add_rectangle(model, {2, -1.5, -1.5}, {0, 3, 0}, {0, 0, 3});
    add_rectangle(model, {2 - gap, -0.4, -0.4}, {0, 0.8, 0}, {0, 0, 0.8});
    const ScannedScene scene = scanned(model, {looking({0, 0, 0}, 0), looking({0.3, 1.2, 0.2}, -30),
                                               looking({0.2, -1.3, -0.2}, 30)});
    const TriangleMesh mesh = reconstruct(with_normals(scene));
    for (const auto& t : mesh.triangles) {
      const Vector3f normal = (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                                  .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                                  .normalized();
      EXPECT_LT(normal.x(), 0.5f) << "faces away from the scanners, gap " << gap;
    }
    EXPECT_LT(deviation_of(mesh, model, 3).p99, 0.03) << gap;
  }
}

TEST(Surface, LeavesAnOpeningOpen) {
  // A hole of 25 cm in a wall, densely scanned.
  TriangleMesh model;
  add_rectangle(model, {2, -1, -1}, {0, 0.8, 0}, {0, 0, 2});
  add_rectangle(model, {2, 0.05, -1}, {0, 0.95, 0}, {0, 0, 2});
  add_rectangle(model, {2, -0.2, -1}, {0, 0.25, 0}, {0, 0, 0.9});
  add_rectangle(model, {2, -0.2, 0.15}, {0, 0.25, 0}, {0, 0, 0.85});
  const TriangleMesh mesh = reconstruct(with_normals(
      scanned(model, {looking({0, 0, 0}, 0), looking({0.1, 0.5, 0}, 0)}, {.slices = 400})));
  for (const Vector3f& v : mesh.vertices)
    EXPECT_FALSE(v.y() > -0.15f && v.y() < 0.0f && v.z() > -0.05f && v.z() < 0.1f) << v.transpose();
}

TEST(Surface, ClosesTheGapsBetweenScanLines) {
  TriangleMesh model;
  add_rectangle(model, {6, -2, -2}, {0, 4, 0}, {0, 0, 4});
  // Lines are 13 cm apart there.
  const ScannedScene scene =
      scanned(model, {looking({0, 0, 0}, 0)},
              {.beams = 721, .slices = 97, .lowest = -60, .highest = 60, .noise = 0.005});
  const Cloud cloud = with_normals(scene);
  const auto open = topology_of(reconstruct(cloud, {.gap_reach = 0}));
  const TriangleMesh mesh = reconstruct(cloud);
  EXPECT_GT(open.components, 5u);
  EXPECT_EQ(topology_of(mesh).components, 1u);
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) area += testing::area_of(mesh, t);
  EXPECT_NEAR(area, 4 * 4, 1.2);  // the outermost lines are not at the border
}

TEST(Surface, IsTheSameForAnyNumberOfThreads) {
  const Cloud cloud =
      with_normals(scanned(testing::room_with_box(), testing::room_poses(), {.slices = 100}));
  set_thread_count(1);
  const TriangleMesh one = reconstruct(cloud);
  set_thread_count(3);
  const TriangleMesh three = reconstruct(cloud);
  set_thread_count(0);
  EXPECT_TRUE(one.vertices == three.vertices);
  EXPECT_TRUE(one.triangles == three.triangles);
}

TEST(Surface, IsNotDisturbedByFarOutliers) {
  Cloud cloud = sphere(0.8, 60000);
  const TriangleMesh before = reconstruct(cloud);
  for (const Vector3f& p : {Vector3f(1e9f, 1e9f, 1e9f), Vector3f(-3e4f, 0, 0)}) {
    cloud.points.push_back(p);
    cloud.normals.push_back({0, 0, 1});
  }
  EXPECT_EQ(reconstruct(cloud).triangles.size(), before.triangles.size());
}

TEST(Surface, SaysWhatIsWrongWithTheInput) {
  EXPECT_EQ(message_of(Cloud{}), "mesh: the cloud has no points");
  Cloud cloud = sphere(0.8, 1000);
  cloud.normals.clear();
  EXPECT_EQ(message_of(cloud), "mesh: 1000 points, but 0 normals");
  cloud.normals.assign(1000, Vector3f::Zero());
  EXPECT_EQ(
      message_of(cloud),
      "mesh: no point has a normal: nowhere do points lie around each other on a surface (are "
      "they in metres, and more than a line of them?)");
  cloud = sphere(0.8, 1000);
  EXPECT_EQ(message_of(cloud, {.voxel = 0}).substr(0, 30), "mesh: voxel must be above 0, i");
  cloud.points[17].y() = std::numeric_limits<float>::infinity();
  EXPECT_EQ(message_of(cloud), "point 17 of 1000 is not finite");
}

/// Origins that cannot be: in a wall, behind it, at a point. What they say is wrong is at most the
/// side of a surface.
TEST(Surface, StandsOriginsInsideWalls) {
  const TriangleMesh model = testing::room_with_box();
  const ScannedScene scene = scanned(model, testing::room_poses(), {.slices = 100});
  for (const Vector3d& wrong : {Vector3d(0, 2, 1), Vector3d(-1, 2, 1), Vector3d(2, 2, -0.001),
                                scene.cloud.points[0].cast<double>().eval()}) {
    Cloud cloud = scene.cloud;
    std::vector<Vector3d> origins = scene.origins;
    origins[1] = wrong;
    cloud.normals = estimate_normals(cloud, origins);
    for (const Vector3f& n : cloud.normals) ASSERT_TRUE(n.isZero() || n.allFinite());
    const TriangleMesh mesh = reconstruct(cloud);
    EXPECT_GT(covered(mesh, scanned(model, testing::room_poses(), {.noise = 0}).cloud, 997), 0.8);
    const Deviation deviation = deviation_of(mesh, model, 29);
    EXPECT_LT(deviation.mean, 0.01);
  }
}

TEST(Surface, OfAFewLoosePointsIsAnError) {
  Cloud cloud;
  cloud.points = {{0, 0, 0}, {5, 0, 0}, {0, 5, 0}};
  cloud.normals.assign(3, {0, 0, 1});
  EXPECT_NE(message_of(cloud).find("no surface in the cloud"), std::string::npos);
}

/// Four of the twelve scans, so that the test is quick.
TEST(Surface, OfTheClassroomIsMillimetresFromTheTruth) {
  PLANUM_SHARED_DATASET(folder, "classroom");
  const std::vector<Pose> poses = read_pose_list(folder / "true_poses.txt");
  const TriangleMesh model = read_obj(folder / "building.obj").mesh;
  std::vector<Scan> scans;
  std::vector<Vector3d> origins;
  for (const int number : {0, 3, 6, 9}) {
    char name[32];
    std::snprintf(name, sizeof name, "scan%03d.slices", number);
    scans.push_back({.id = name,
                     .number = number,
                     .world_from_scan = poses[std::size_t(number)],
                     .cloud = points_from_slices(read_slices(folder / name)).cloud});
    origins.push_back(scans.back().world_from_scan.translation());
  }
  Cloud cloud = merged(scans);
  cloud.normals = estimate_normals(cloud, origins);
  const TriangleMesh mesh = reconstruct(cloud);
  const Deviation deviation = deviation_of(mesh, model, 29);
  RecordProperty("mean_mm", std::to_string(1000 * deviation.mean));
  EXPECT_LT(deviation.mean, 0.003);
  EXPECT_LT(deviation.p99, 0.02);
  EXPECT_EQ(topology_of(mesh).crowded_edges, 0u);
}

}  // namespace
}  // namespace planum
