#include "slam/graph/pose_manifold.hpp"

#include <gtest/gtest.h>

#include "tests/slam/graph/synthetic_graph.hpp"

namespace planum {
namespace {

using testing::normal_vector;
using testing::turned_pose;

template <class Manifold>
typename Manifold::PoseType random_pose(std::mt19937& random) {
  if constexpr (Manifold::space == 3)
    return turned_pose(random, 3);
  else
    return flattened(turned_pose(random, 3));
}

template <class Manifold>
class PoseManifold : public ::testing::Test {};
using Manifolds = ::testing::Types<SpatialManifold, PlanarManifold>;
TYPED_TEST_SUITE(PoseManifold, Manifolds);

TYPED_TEST(PoseManifold, HasTheDerivativesOfItsErrors) {
  using M = TypeParam;
  std::mt19937 random(1);
  constexpr double h = 1e-6;
  for (const RotationError kind : {RotationError::chord, RotationError::angle})
    for (int draw = 0; draw < 50; ++draw) {
      const auto from = random_pose<M>(random), to = random_pose<M>(random);
      // An error of rotation of up to 2 rad or so: near pi it has a jump.
      const auto measured =
          M::moved(M::product(M::inverse(from), to), 0.6 * normal_vector<M::dimension>(random));
      const auto l = M::linearized(from, to, measured, kind);
      EXPECT_LT((l.error - M::error(from, to, measured, kind)).norm(), 1e-14);
      for (int i = 0; i < M::dimension; ++i) {
        const typename M::Vector step = h * M::Vector::Unit(i);
        const typename M::Vector by_from = (M::error(M::moved(from, step), to, measured, kind) -
                                            M::error(M::moved(from, -step), to, measured, kind)) /
                                           (2 * h);
        const typename M::Vector by_to = (M::error(from, M::moved(to, step), measured, kind) -
                                          M::error(from, M::moved(to, -step), measured, kind)) /
                                         (2 * h);
        EXPECT_LT((by_from - l.by_from.col(i)).norm(), 1e-8);
        EXPECT_LT((by_to - l.by_to.col(i)).norm(), 1e-8);
      }
    }
}

TYPED_TEST(PoseManifold, ErrorsAgreeToFirstOrderWithTheMotionThatIsLeft) {
  using M = TypeParam;
  std::mt19937 random(2);
  for (const RotationError kind : {RotationError::chord, RotationError::angle})
    for (int draw = 0; draw < 20; ++draw) {
      const auto from = random_pose<M>(random), measured = random_pose<M>(random);
      const typename M::Vector motion = 1e-5 * normal_vector<M::dimension>(random);
      const auto to = M::moved(M::product(from, measured), motion);
      EXPECT_LT((M::error(from, to, measured, kind) - motion).norm(), 1e-9);
    }
}

TYPED_TEST(PoseManifold, IsAGroup) {
  using M = TypeParam;
  std::mt19937 random(3);
  for (int draw = 0; draw < 20; ++draw) {
    const auto a = random_pose<M>(random), b = random_pose<M>(random);
    const auto again = M::product(M::inverse(a), M::product(a, b));
    EXPECT_LT((M::position(again) - M::position(b)).norm(), 1e-13);
    EXPECT_LT((M::rotation(again) - M::rotation(b)).norm(), 1e-13);
    // world_from_own: a small motion in the frame of the pose is the same motion of the world.
    const typename M::Vector motion = 1e-6 * normal_vector<M::dimension>(random);
    const typename M::Vector of_world = M::world_from_own(a) * motion;
    const auto here = M::moved(a, motion);
    const auto there = M::product(M::moved(M::identity(), of_world), a);
    EXPECT_LT((M::position(here) - M::position(there)).norm(), 1e-10);
    EXPECT_LT((M::rotation(here) - M::rotation(there)).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace planum
