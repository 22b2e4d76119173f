#include "labeling/keepout.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/labeling/plans.hpp"

namespace planum {
namespace {

using testing::PlanMaker;
using testing::Vector3d;

/// A landing at z = 0, beside it a flight down to a floor 1 m lower and an open edge above it.
PlanMaker landing() {
  PlanMaker plan;
  plan.add("floor", {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}});
  for (int k = 1; k <= 4; ++k)
    plan.add("stair", {{3 + 0.3 * (k - 1), 0, -0.2 * k},
                       {3 + 0.3 * k, 0, -0.2 * k},
                       {3 + 0.3 * k, 1, -0.2 * k},
                       {3 + 0.3 * (k - 1), 1, -0.2 * k}});
  plan.add("floor", {{3, 1, -1}, {6, 1, -1}, {6, 4, -1}, {3, 4, -1}});
  plan.add("floor", {{0, -2, 0.03}, {3, -2, 0.03}, {3, 0, 0.03}, {0, 0, 0.03}});
  plan.add("floor", {{0, 0, 3}, {3, 0, 3}, {3, 4, 3}, {0, 4, 3}});
  return plan;
}

Labels labels_of(const PlanMaker& plan) {
  Labels labels;
  for (const std::string& word : plan.labels)
    for (const Label label : all_labels)
      if (name(label) == word) labels.polygons.push_back({label, 1});
  return labels;
}

OccupancyGrid storey() {
  OccupancyGrid grid;
  grid.grid.cell = 0.05;
  grid.grid.columns = 160;
  grid.grid.rows = 140;
  grid.grid.plan_from_world = Pose(Eigen::Translation3d(1, 2.5, 0));
  return grid;
}

TEST(KeepoutMask, ForbidsStairsAndDropOffs) {
  const PlanMaker plan = landing();
  const OccupancyGrid mask = keepout_mask(plan.map, labels_of(plan), storey());
  const auto at = [&](double x, double y) {
    const auto cell = mask.grid.find({x + 1, y + 2.5});
    return mask.cells.at(static_cast<std::size_t>(cell));
  };
  EXPECT_EQ(at(1.5, 2), Occupancy::free);
  EXPECT_EQ(at(2.97, 3.97), Occupancy::free);
  EXPECT_EQ(at(1.5, -1), Occupancy::free);  // a step no robot minds
  EXPECT_EQ(at(3.1, 0.5), Occupancy::occupied);
  EXPECT_EQ(at(4.1, 0.5), Occupancy::occupied);
  EXPECT_EQ(at(4, 3), Occupancy::occupied);  // the lower floor
  EXPECT_EQ(at(-0.5, 0), Occupancy::unknown);
  EXPECT_EQ(at(5, 0.5), Occupancy::unknown);
}

TEST(KeepoutMask, KnowsTheLowerStorey) {
  const PlanMaker plan = landing();
  OccupancyGrid lower = storey();
  lower.floor = -1;
  const OccupancyGrid mask = keepout_mask(plan.map, labels_of(plan), lower);
  const auto cell = static_cast<std::size_t>(mask.grid.find({5, 5.5}));
  EXPECT_EQ(mask.cells.at(cell), Occupancy::free);
}

TEST(KeepoutMask, SaysWhatIsWrong) {
  const PlanMaker plan = landing();
  EXPECT_THROW(keepout_mask(plan.map, {}, storey()), Error);
  EXPECT_THROW(keepout_mask(plan.map, labels_of(plan), storey(), {.max_step = -1}), Error);
  EXPECT_THROW(keepout_mask(plan.map, labels_of(plan), storey(), {.max_slope = 2}), Error);
}

}  // namespace
}  // namespace planum
