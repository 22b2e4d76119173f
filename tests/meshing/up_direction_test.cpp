#include "meshing/up_direction.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/core/pose.hpp"

namespace planum {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Normals of surfaces, with noise.
class Normals {
 public:
  void add(const Vector3d& direction, int count, double noise_deg = 2) {
    std::normal_distribution<double> noise(0, radians(noise_deg));
    for (int i = 0; i < count; ++i)
      all_.push_back((direction + Vector3d(noise(random_), noise(random_), noise(random_)))
                         .normalized()
                         .cast<float>());
  }
  void add_clutter(int count) {
    std::normal_distribution<double> any(0, 1);
    for (int i = 0; i < count; ++i)
      all_.push_back(Vector3d(any(random_), any(random_), any(random_)).normalized().cast<float>());
  }
  std::vector<Vector3f> turned(const Matrix3d& turn) const {
    std::vector<Vector3f> result;
    for (const Vector3f& n : all_) result.push_back(turn.cast<float>() * n);
    return result;
  }

 private:
  std::mt19937 random_{3};
  std::vector<Vector3f> all_;
};

Normals room() {
  Normals normals;
  normals.add({0, 0, 1}, 20000);
  normals.add({0, 0, -1}, 15000);
  for (const double angle : {0.3, 0.3 + pi / 2, 0.3 + pi, 0.3 - pi / 2})
    normals.add({std::cos(angle), std::sin(angle), 0}, 15000);
  normals.add_clutter(20000);
  return normals;
}

Matrix3d tilt(double angle_deg, double towards) {
  return Eigen::AngleAxisd(radians(angle_deg), Vector3d(std::cos(towards), std::sin(towards), 0))
      .toRotationMatrix();
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return degrees(std::atan2(a.cross(b).norm(), a.dot(b)));
}

TEST(UpDirection, IsThatOfTheFloorHoweverTheSceneIsTurned) {
  const Normals normals = room();
  for (const double angle : {0.0, 3.0, 20.0, 35.0})
    for (const double towards : {0.5, 4.0}) {
      const Matrix3d turn = tilt(angle, towards);
      const auto found = estimate_up(normals.turned(turn), {}, Vector3d::UnitZ());
      ASSERT_TRUE(found);
      EXPECT_LT(angle_between(found->up, turn.col(2)), 0.05) << angle << " " << towards;
      EXPECT_GT(found->confidence, 0.5);
    }
}

TEST(UpDirection, IsNotSeenWhereNothingIsHorizontal) {
  Normals walls;
  walls.add({1, 0, 0}, 20000);
  walls.add({0, 1, 0}, 20000);
  walls.add_clutter(5000);
  EXPECT_FALSE(estimate_up(walls.turned(Matrix3d::Identity()), {}, Vector3d::UnitZ()));
  EXPECT_FALSE(estimate_up({}, {}, Vector3d::UnitZ()));
  const std::vector<Vector3f> unknown(100, Vector3f::Zero());
  EXPECT_FALSE(estimate_up(unknown, {}, Vector3d::UnitZ()));
}

TEST(UpDirection, IsNotASlopingRoof) {
  Normals attic;
  attic.add({0, 0, 1}, 20000);
  attic.add({0.6, 0, -0.8}, 30000);
  attic.add({0, 1, 0}, 15000);
  attic.add({0, -1, 0}, 15000);
  attic.add({1, 0, 0}, 15000);
  const auto found = estimate_up(attic.turned(Matrix3d::Identity()), {}, Vector3d::UnitZ());
  ASSERT_TRUE(found);
  EXPECT_LT(angle_between(found->up, Vector3d::UnitZ()), 0.2);
}

TEST(UpDirection, FollowsThePriorNotTheSignsOfNormals) {
  Normals ceiling;
  ceiling.add({0, 0, -1}, 20000);
  const auto normals = ceiling.turned(tilt(10, 0.5));
  const auto found = estimate_up(normals, {}, Vector3d::UnitZ());
  ASSERT_TRUE(found);
  EXPECT_GT(found->up.z(), 0.9);
  const auto upside_down = estimate_up(normals, {}, -Vector3d::UnitZ());
  ASSERT_TRUE(upside_down);
  EXPECT_LT(upside_down->up.z(), -0.9);
}

TEST(UpDirection, UsesWeights) {
  Normals two;
  two.add({0, 0, 1}, 1000, 0.5);
  two.add({0, 0.5, 0.866}, 3000, 0.5);
  std::vector<float> weights(4000, 1.0f);
  std::fill_n(weights.begin(), 1000, 10.0f);
  const auto normals = two.turned(Matrix3d::Identity());
  EXPECT_LT(angle_between(estimate_up(normals, weights, Vector3d::UnitZ())->up, Vector3d::UnitZ()),
            1);
  EXPECT_GT(angle_between(estimate_up(normals, {}, Vector3d::UnitZ())->up, Vector3d::UnitZ()), 25);
}

TEST(UpDirection, IsSurerOfARoomThanOfClutter) {
  Normals clutter;
  clutter.add({0, 0, 1}, 3000);
  clutter.add_clutter(60000);
  const auto sure = estimate_up(room().turned(Matrix3d::Identity()), {}, Vector3d::UnitZ());
  const auto unsure = estimate_up(clutter.turned(Matrix3d::Identity()), {}, Vector3d::UnitZ());
  ASSERT_TRUE(sure && unsure);
  EXPECT_GT(sure->confidence, 3 * unsure->confidence);
}

TEST(UpDirection, IsTheSameForAnyNumberOfThreads) {
  const auto normals = room().turned(tilt(7, 2));
  set_thread_count(1);
  const auto one = estimate_up(normals, {}, Vector3d::UnitZ());
  set_thread_count(3);
  const auto three = estimate_up(normals, {}, Vector3d::UnitZ());
  set_thread_count(0);
  EXPECT_TRUE(one->up == three->up);
  EXPECT_EQ(one->confidence, three->confidence);
}

TEST(UpDirection, SaysWhatIsWrongWithTheInput) {
  const std::vector<Vector3f> normals(3, Vector3f::UnitZ());
  const std::vector<float> weights(2, 1.0f);
  EXPECT_THROW(estimate_up(normals, weights, Vector3d::UnitZ()), Error);
  EXPECT_THROW(estimate_up(normals, {}, Vector3d::Zero()), Error);
}

}  // namespace
}  // namespace planum
