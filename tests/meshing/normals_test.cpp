#include "meshing/normals.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "scanned_scene.hpp"
#include "slam/core/error.hpp"
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
using testing::looking;
using testing::scanned;
using testing::ScannedScene;

/// The room with noise; made once.
const ScannedScene& noisy_room() {
  static const ScannedScene scene =
      scanned(testing::room_with_box(), testing::room_poses(), {.slices = 150});
  return scene;
}

/// How normals compare to the true ones.
struct Quality {
  double wrong_side = 0;       ///< share
  double none = 0;             ///< share
  double median = 0, p95 = 0;  ///< deg
};

Quality quality_of(const std::vector<Vector3f>& normals, const std::vector<Vector3f>& truth) {
  std::vector<double> errors;
  double wrong = 0, none = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (normals[i].isZero()) {
      ++none;
      continue;
    }
    const double cosine = std::clamp(double(normals[i].dot(truth[i])), -1.0, 1.0);
    wrong += cosine < 0;
    errors.push_back(degrees(std::acos(cosine)));
  }
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  return {wrong / count, none / static_cast<double>(truth.size()), errors[errors.size() / 2],
          errors[errors.size() * 95 / 100]};
}

std::string message_of(const Cloud& cloud, const std::vector<Vector3d>& origins,
                       const NormalParams& params = {}) {
  try {
    estimate_normals(cloud, origins, params);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(Normals, PointAtTheScannerInANoisyRoom) {
  const ScannedScene& scene = noisy_room();
  const Quality q = quality_of(estimate_normals(scene.cloud, scene.origins), scene.normals);
  RecordProperty("wrong_side", std::to_string(q.wrong_side));
  EXPECT_LT(q.wrong_side, 0.002);
  EXPECT_LT(q.none, 0.005);
  EXPECT_LT(q.median, 1.0);
  EXPECT_LT(q.p95, 8.0);
}

TEST(Normals, StaySharpAtCreasesOfCleanData) {
  const ScannedScene scene =
      scanned(testing::room_with_box(), testing::room_poses(), {.noise = 0.0});
  const Quality q = quality_of(estimate_normals(scene.cloud, scene.origins), scene.normals);
  EXPECT_LT(q.median, 0.05);
  EXPECT_LT(q.p95, 1.0);
}

TEST(Normals, DoNotMixTheTwoSidesOfAThinWall) {
  for (const double thickness : {0.10, 0.15}) {
    TriangleMesh model;
    add_box(model, {-4, -3, -1}, {0, 3, 2});
    add_box(model, {thickness, -3, -1}, {4, 3, 2});
    const ScannedScene scene =
        scanned(model, {looking({-2, 0, 0}, 0), looking({2, 0.3, 0.2}, 180),
                        looking({-1, -2.7, 0}, 80), looking({1, -2.6, 0}, 100)});
    const auto normals = estimate_normals(scene.cloud, scene.origins);
    std::vector<Vector3f> at_wall, truth;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const Vector3f& p = scene.cloud.points[i];
      if (std::abs(double(p.x()) - thickness / 2) > 0.15 || std::abs(p.y()) > 2.9f) continue;
      if (std::abs(scene.normals[i].x()) < 0.5f || p.z() < -0.9f || p.z() > 1.9f) continue;
      at_wall.push_back(normals[i]);
      truth.push_back(scene.normals[i]);
    }
    ASSERT_GT(at_wall.size(), 10000u);
    const Quality q = quality_of(at_wall, truth);
    EXPECT_LT(q.wrong_side, 1e-4) << thickness;
    EXPECT_LT(q.median, 1.0) << thickness;
    EXPECT_LT(q.p95, 5.0) << thickness;
  }
}

TEST(Normals, FollowTheSurfaceAcrossTheLinesOfATiltedLaser) {
  // At 8 m, points are 3.5 cm apart along a scan line, and lines 22 cm.
  TriangleMesh model;
  add_rectangle(model, {8, -3, -3}, {0, 6, 0}, {1, 0, 6});
  const ScannedScene scene =
      scanned(model, {looking({0, 0, 0}, 0)},
              {.beams = 721, .slices = 76, .lowest = -60, .highest = 60, .noise = 0.01});
  const Quality q = quality_of(estimate_normals(scene.cloud, scene.origins), scene.normals);
  EXPECT_EQ(q.wrong_side, 0);
  EXPECT_LT(q.none, 0.02);
  EXPECT_LT(q.median, 2.0);
  EXPECT_LT(q.p95, 5.0);
}

TEST(Normals, OfStrayPointsAreZero) {
  ScannedScene scene = noisy_room();
  const std::size_t count = scene.cloud.points.size();
  for (const Vector3f& p : {Vector3f(1.5f, 2, 1.3f), Vector3f(2.2f, 2.9f, 1.8f)}) {
    scene.cloud.points.push_back(p);
    scene.cloud.scan.push_back(0);
  }
  const auto normals = estimate_normals(scene.cloud, scene.origins);
  EXPECT_TRUE(normals[count].isZero());
  EXPECT_TRUE(normals[count + 1].isZero());
}

TEST(Normals, AreUnitOrZero) {
  const ScannedScene& scene = noisy_room();
  for (const Vector3f& n : estimate_normals(scene.cloud, scene.origins))
    EXPECT_TRUE(n.isZero() || std::abs(n.norm() - 1) < 1e-5f);
}

TEST(Normals, TurnWithTheScene) {
  ScannedScene scene = noisy_room();
  const Pose turn = pose_from_xyz_ypr({3, -2, 1}, 0.7, 0.1, -0.2);
  scene.cloud = transformed(scene.cloud, turn);
  for (Vector3d& origin : scene.origins) origin = turn * origin;
  for (Vector3f& normal : scene.normals) normal = turn.linear().cast<float>() * normal;
  const Quality q = quality_of(estimate_normals(scene.cloud, scene.origins), scene.normals);
  EXPECT_LT(q.wrong_side, 0.002);
  EXPECT_LT(q.median, 1.0);
}

TEST(Normals, AreTheSameForAnyNumberOfThreads) {
  const ScannedScene& scene = noisy_room();
  set_thread_count(1);
  const auto one = estimate_normals(scene.cloud, scene.origins);
  for (const int threads : {2, 5}) {
    set_thread_count(threads);
    EXPECT_TRUE(estimate_normals(scene.cloud, scene.origins) == one) << threads;
  }
  set_thread_count(0);
}

TEST(Normals, AreNotDisturbedByAFarOutlier) {
  ScannedScene scene = noisy_room();
  const auto before = estimate_normals(scene.cloud, scene.origins);
  scene.cloud.points.push_back({1e9f, -1e9f, 1e9f});
  scene.cloud.scan.push_back(1);
  auto after = estimate_normals(scene.cloud, scene.origins);
  EXPECT_TRUE(after.back().isZero());
  after.pop_back();
  EXPECT_TRUE(after == before);
}

TEST(Normals, OfNothingAreNothing) {
  EXPECT_TRUE(estimate_normals(Cloud{}, std::vector<Vector3d>{Vector3d::Zero()}).empty());
}

TEST(Normals, OfEqualPointsAreZero) {
  Cloud cloud;
  cloud.points.assign(1000, {1, 2, 3});
  for (const Vector3f& n : estimate_normals(cloud, std::vector<Vector3d>{Vector3d::Zero()}))
    EXPECT_TRUE(n.isZero());
}

TEST(Normals, OfALineAreZero) {
  Cloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.points.push_back({0.01f * float(i), 1, 0});
  for (const Vector3f& n : estimate_normals(cloud, std::vector<Vector3d>{Vector3d::Zero()}))
    EXPECT_TRUE(n.isZero());
}

TEST(Normals, SayWhatIsWrongWithTheInput) {
  Cloud cloud;
  cloud.points = {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
  const std::vector<Vector3d> one = {{0, 0, 1}}, two = {{0, 0, 1}, {0, 0, 2}};
  EXPECT_EQ(message_of(cloud, one), "point 2 of 3 is not finite");
  cloud.points[2] = {0, 1, 0};
  EXPECT_NE(message_of(cloud, {}).find("no scan origins"), std::string::npos);
  EXPECT_NE(message_of(cloud, two).find("do not say which scan"), std::string::npos);
  cloud.scan = {0, 1, 5};
  EXPECT_NE(message_of(cloud, two).find("point 2 is from scan 5, but there are only 2"),
            std::string::npos);
  cloud.scan = {0, 1};
  EXPECT_NE(message_of(cloud, two).find("3 points, but 2 scan indices"), std::string::npos);
  EXPECT_NE(message_of(cloud, one, {.cell = -1}).find("cell must be above 0"), std::string::npos);
}

/// Where the beams of the classroom's scans really end: the model is known.
TEST(Normals, ReachTheIssuesFiguresOnTheClassroom) {
  PLANUM_SHARED_DATASET(folder, "classroom");
  const std::vector<Pose> poses = read_pose_list(folder / "true_poses.txt");
  const RayCaster caster(read_obj(folder / "building.obj").mesh);
  std::vector<Scan> scans;
  for (const int number : {0, 5, 11}) {
    char name[32];
    std::snprintf(name, sizeof name, "scan%03d.slices", number);
    scans.push_back({.id = name,
                     .number = number,
                     .world_from_scan = poses[std::size_t(number)],
                     .cloud = points_from_slices(read_slices(folder / name)).cloud});
  }
  const Cloud cloud = merged(scans);
  std::vector<Vector3d> origins;
  for (const Scan& scan : scans) origins.push_back(scan.world_from_scan.translation());
  const auto normals = estimate_normals(cloud, origins);
  std::vector<Vector3f> judged, truth;
  for (std::size_t i = 0; i < normals.size(); i += 7) {
    const Vector3d direction =
        (cloud.points[i].cast<double>() - origins[cloud.scan[i]]).normalized();
    const auto hit = caster.cast(origins[cloud.scan[i]], direction, 100);
    if (!hit) continue;
    judged.push_back(normals[i]);
    truth.push_back(hit->normal.dot(direction.cast<float>()) < 0 ? hit->normal
                                                                 : Vector3f(-hit->normal));
  }
  const Quality q = quality_of(judged, truth);
  RecordProperty("wrong_side", std::to_string(q.wrong_side));
  RecordProperty("median_deg", std::to_string(q.median));
  EXPECT_LT(q.wrong_side, 0.005);
  EXPECT_LT(q.median, 2.0);
  EXPECT_LT(q.none, 0.01);
}

}  // namespace
}  // namespace planum
