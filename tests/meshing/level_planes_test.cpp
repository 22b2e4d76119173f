#include "meshing/level_planes.hpp"

#include <random>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;

/// Points on things in a room, with noise across their surfaces and worse in their normals.
class Scene {
 public:
  void add_level(double height, double width, double depth, int count, bool faces_up) {
    std::uniform_real_distribution<double> share(-0.5, 0.5);
    for (int i = 0; i < count; ++i)
      add({width * share(random_), depth * share(random_), height + 0.01 * normal_(random_)},
          {0, 0, faces_up ? 1.0 : -1.0});
  }
  void add_wall(int count) {
    std::uniform_real_distribution<double> share(0, 2.5);
    for (int i = 0; i < count; ++i) add({3, share(random_), share(random_)}, {-1, 0, 0});
  }
  /// The scene turned, so that (0, 0, 1) becomes turn * (0, 0, 1).
  Cloud turned(const Eigen::Matrix3d& turn) const {
    Cloud cloud;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      cloud.points.push_back((turn * points_[i] + Vector3d(40, -30, 5)).cast<float>());
      cloud.normals.push_back((turn * normals_[i]).cast<float>());
    }
    return cloud;
  }

 private:
  void add(const Vector3d& point, const Vector3d& normal) {
    points_.push_back(point);
    const Vector3d error(normal_(random_), normal_(random_), normal_(random_));
    normals_.push_back((normal + 0.02 * error).normalized());
  }

  std::mt19937 random_{5};
  std::normal_distribution<double> normal_{0, 1};
  std::vector<Vector3d> points_, normals_;
};

Eigen::Matrix3d tilt(double degrees_of_tilt, double towards) {
  return Eigen::AngleAxisd(radians(degrees_of_tilt),
                           Vector3d(std::cos(towards), std::sin(towards), 0))
      .toRotationMatrix();
}

double error_deg(const Vector3d& up, const Eigen::Matrix3d& turn) {
  return degrees(std::acos(std::min(1.0, up.dot(turn * Vector3d::UnitZ()))));
}

TEST(UpOfPlanes, IsThatOfFloorsTablesAndCeilings) {
  Scene scene;
  scene.add_level(0, 8, 6, 20000, true);
  scene.add_level(0.16, 2, 1.5, 2000, true);  // a step
  scene.add_level(0.75, 1.4, 0.7, 1500, true);
  scene.add_level(2.6, 8, 6, 15000, false);
  scene.add_wall(8000);
  for (const double towards : {0.0, 0.7, 2.1, 4.0}) {
    const Eigen::Matrix3d turn = tilt(1.0, towards);
    const Vector3d up = up_of_planes(scene.turned(turn), Vector3d::UnitZ());
    EXPECT_LT(error_deg(up, turn), 0.01) << towards;
  }
}

TEST(UpOfPlanes, StaysWhereTheFloorDoesNotSay) {
  Scene scene;
  scene.add_level(0, 10, 0.02, 5000, true);  // hardly a strip along x
  const Eigen::Matrix3d about_y = tilt(1.0, pi / 2), about_x = tilt(0.5, 0);
  EXPECT_LT(error_deg(up_of_planes(scene.turned(about_y), Vector3d::UnitZ()), about_y), 0.05);
  const Vector3d up = up_of_planes(scene.turned(about_x), Vector3d::UnitZ());
  EXPECT_LT(degrees(std::acos(up.z())), 0.1);
}

TEST(UpOfPlanes, IsTheGuessWhereNothingIsLevel) {
  Scene scene;
  scene.add_wall(5000);
  const Vector3d guess = Vector3d(0.01, 0.02, 1).normalized();
  EXPECT_LT((up_of_planes(scene.turned(Eigen::Matrix3d::Identity()), guess) - guess).norm(), 1e-12);
  EXPECT_LT((up_of_planes({}, guess) - guess).norm(), 1e-12);
}

TEST(UpOfPlanes, SaysWhatIsWrongWithTheInput) {
  Cloud cloud;
  cloud.points.resize(3, Eigen::Vector3f::Zero());
  EXPECT_THROW(up_of_planes(cloud, Vector3d::UnitZ()), Error);
  EXPECT_THROW(up_of_planes({}, Vector3d::Zero()), Error);
}

}  // namespace
}  // namespace planum
