#include "labeling/plan/plan_ring.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace planum {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

TEST(PlanRing, LosesSlitsAndSpikesWhereverItBegins) {
  // A room of 4 x 3 m with a spike into it and a slit out of it.
  const Ring room = {{0, 0}, {4, 0}, {4, 1.5}, {4.6, 1.52}, {4.6, 1.56}, {4, 1.58},
                     {4, 3}, {0, 3}, {0, 2},   {0.5, 1.98}, {0.5, 2.03}, {0, 1.95}};
  for (std::size_t first = 0; first < room.size(); ++first) {
    Ring ring = room;
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(first), ring.end());
    const Ring clean = without_slits(ring, 0.12);
    EXPECT_NEAR(ring_area(clean), 12, 1e-9) << first;
    EXPECT_LE(clean.size(), 8u);
    for (const Eigen::Vector2d& p : clean)
      EXPECT_TRUE(std::find(room.begin(), room.end(), p) != room.end());
  }
}

TEST(PlanRing, KeepsNichesCornersAndSmallRings) {
  const Ring niche = {{0, 0}, {4, 0}, {4, 1}, {4.5, 1}, {4.5, 1.3}, {4, 1.3}, {4, 3}, {0, 3}};
  EXPECT_EQ(without_slits(niche, 0.12), niche);
  const Ring chamfer = {{0, 0}, {3.95, 0}, {4, 0.05}, {4, 3}, {0, 3}};
  EXPECT_EQ(without_slits(chamfer, 0.12), chamfer);
  const Ring needle = {{0, 0}, {2, 0.01}, {0, 0.02}};
  EXPECT_EQ(without_slits(needle, 0.12), needle);
  EXPECT_TRUE(without_slits({}, 0.12).empty());
}

}  // namespace
}  // namespace planum
