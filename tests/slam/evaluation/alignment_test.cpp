#include "slam/evaluation/alignment.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace planum {
namespace {

class Draws {
 public:
  explicit Draws(unsigned seed) : random_(seed) {}
  Eigen::Vector3d vector(double size) {
    return size * Eigen::Vector3d(normal_(random_), normal_(random_), normal_(random_));
  }
  Pose pose() {
    Vector6d twist;
    twist << vector(5), vector(0.8);
    return exp_se3(twist);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0, 1};
};

double squared_distances(const Pose& b_from_a, const std::vector<Eigen::Vector3d>& a,
                         const std::vector<Eigen::Vector3d>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (b_from_a * a[i] - b[i]).squaredNorm();
  return sum;
}

TEST(UmeyamaAlignment, RecoversAKnownMotion) {
  Draws draws(1);
  for (int draw = 0; draw < 50; ++draw) {
    const Pose b_from_a = draws.pose();
    std::vector<Eigen::Vector3d> a, b;
    for (int i = 0; i < 3 + draw; ++i) {
      a.push_back(draws.vector(4));
      b.push_back(b_from_a * a.back());
    }
    const auto found = umeyama_alignment(a, b);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((found->matrix() - b_from_a.matrix()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(UmeyamaAlignment, HasTheLeastSumOfSquares) {
  Draws draws(2);
  for (int draw = 0; draw < 20; ++draw) {
    std::vector<Eigen::Vector3d> a, b;
    for (int i = 0; i < 12; ++i) {
      a.push_back(draws.vector(3));
      b.push_back(a.back() + draws.vector(1));
    }
    const auto best = umeyama_alignment(a, b);
    ASSERT_TRUE(best.has_value());
    const double least = squared_distances(*best, a, b);
    for (int k = 0; k < 50; ++k) {
      Vector6d nudge;
      nudge << draws.vector(0.05), draws.vector(0.05);
      EXPECT_GE(squared_distances(exp_se3(nudge) * *best, a, b), least);
    }
  }
}

TEST(UmeyamaAlignment, IsARotationEvenForMirroredPoints) {
  Draws draws(3);
  std::vector<Eigen::Vector3d> a, b;
  for (int i = 0; i < 10; ++i) {
    a.push_back(draws.vector(2));
    b.emplace_back(-a.back().x(), a.back().y(), a.back().z());
  }
  const auto found = umeyama_alignment(a, b);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->linear().determinant(), 1, 1e-12);
}

TEST(UmeyamaAlignment, IsEmptyWherePointsLeaveARotationOpen) {
  const std::vector<Eigen::Vector3d> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(umeyama_alignment(two, two).has_value());
  const std::vector<Eigen::Vector3d> place(5, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(umeyama_alignment(place, place).has_value());
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 10; ++i) line.emplace_back(i, 2 * i, -i);
  EXPECT_FALSE(umeyama_alignment(line, line).has_value());
}

TEST(JointAlignment, RecoversAKnownMotionFromAnyPoses) {
  Draws draws(4);
  for (const int count : {1, 2, 3, 20}) {
    const Pose b_from_a = draws.pose();
    std::vector<Pose> a, b;
    for (int i = 0; i < count; ++i) {
      a.push_back(draws.pose());
      b.push_back(b_from_a * a.back());
    }
    const Pose found = joint_alignment(a, b, 3);
    EXPECT_LT((found.matrix() - b_from_a.matrix()).cwiseAbs().maxCoeff(), 1e-9) << count;
  }
  EXPECT_TRUE(joint_alignment({}, {}, 3).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace planum
