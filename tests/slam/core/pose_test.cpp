#include "slam/core/pose.hpp"

#include <random>

#include <gtest/gtest.h>

namespace planum {
namespace {

Vector6d random_twist(std::mt19937& random, double length) {
  std::normal_distribution<double> normal;
  Vector6d twist;
  for (double& x : twist) x = normal(random);
  twist.head<3>() *= 3;
  twist.tail<3>() *= length / twist.tail<3>().norm();
  return twist;
}

TEST(Pose, LogIsTheInverseOfExp) {
  std::mt19937 random(1);
  for (const double angle :
       {1e-14, 1e-9, 1e-5, 9.9e-5, 1.1e-4, 9e-4, 1.1e-3, 0.1, 1.0, 3.0, 3.14, pi - 1e-7}) {
    for (int i = 0; i < 50; ++i) {
      const Vector6d twist = random_twist(random, angle);
      EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-7) << "angle " << angle;
    }
  }
  EXPECT_EQ(log_se3(Pose::Identity()), Vector6d::Zero());
}

TEST(Pose, ExpIsARigidMotion) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const Pose pose = exp_se3(random_twist(random, 0.01 * i));
    EXPECT_LT((pose.linear() * pose.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
              1e-12);
    EXPECT_NEAR(pose.linear().determinant(), 1, 1e-12);
  }
}

TEST(Pose, ExpOfATwistIsTheLimitOfSmallSteps) {
  std::mt19937 random(3);
  const Vector6d twist = random_twist(random, 1.2);
  Pose steps = Pose::Identity();
  for (int i = 0; i < 1000; ++i) steps = steps * exp_se3(twist / 1000);
  EXPECT_LT((steps.matrix() - exp_se3(twist).matrix()).norm(), 1e-10);
}

TEST(Pose, AdjointMovesATwistThroughAPose) {
  std::mt19937 random(4);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = exp_se3(random_twist(random, 1.0));
    const Vector6d twist = random_twist(random, 0.5);
    const Pose left = exp_se3(adjoint(pose) * twist),
               right = pose * exp_se3(twist) * pose.inverse();
    EXPECT_LT((left.matrix() - right.matrix()).norm(), 1e-10);
  }
}

TEST(Pose, YawTurnsForwardToLeftAndPitchTurnsForwardDown) {
  const Pose yaw = pose_from_xyz_ypr({1, 2, 3}, radians(90), 0, 0);
  EXPECT_LT((yaw * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 3, 3)).norm(), 1e-12);
  const Pose pitch = pose_from_xyz_ypr({0, 0, 0}, 0, radians(90), 0);
  EXPECT_LT((pitch * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Pose, RotationAngleIsExactForTinyAndLargeAngles) {
  for (const double angle : {1e-9, 1e-4, 1.0, 3.1415}) {
    const Pose turned = pose_from_xyz_ypr({5, 0, 0}, angle, 0, 0);
    EXPECT_NEAR(rotation_angle(Pose::Identity(), turned), angle, 1e-12);
  }
}

}  // namespace
}  // namespace planum
