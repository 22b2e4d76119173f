#include "slam/graph/scan_descriptor.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/slam/registration/simulated_room.hpp"

namespace planum {
namespace {

using testing::message_of;
using testing::scan_of;

double distance(const ScanDescriptor& a, const ScanDescriptor& b) {
  double squares = 0;
  for (std::size_t i = 0; i < ScanDescriptor::size; ++i)
    squares += std::pow(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i]), 2);
  return std::sqrt(squares);
}

ScanDescriptor seen_from(const Building& building, const Pose& pose, std::uint64_t number,
                         const Pose& turn = Pose::Identity()) {
  return scan_descriptor(matching_scan(transformed(scan_of(building, pose, number), turn)));
}

Building bare_room() {
  BuildingPlan plan;
  plan.rooms = {
      {.name = "room", .walls = {.outer = {{0, 0}, {9, 0}, {9, 7}, {0, 7}}}, .height = 3.4}};
  return built(plan);
}

const Pose here = pose_from_xyz_ypr({1.0, 1.2, 1.0}, 0.5, 0, 0);

TEST(ScanDescriptor, IsMuchTheSameTurnedAndMoved) {
  const Building room = testing::furnished_room();
  const ScanDescriptor a = seen_from(room, here, 0);
  const double elsewhere =
      distance(a, seen_from(bare_room(), pose_from_xyz_ypr({2, 3, 1.0}, 0.5, 0, 0), 9));
  for (const double turn : {0.4, 1.9, -2.7})
    EXPECT_LT(distance(a, seen_from(room, here, 1, pose_from_xyz_ypr({0, 0, 0}, turn, 0, 0))),
              0.4 * elsewhere);
  // Tilted, and higher up.
  EXPECT_LT(distance(a, seen_from(room, here, 1, pose_from_xyz_ypr({0, 0, 0}, 0.3, 0.05, 0.03))),
            0.4 * elsewhere);
  EXPECT_LT(distance(a, seen_from(room, pose_from_xyz_ypr({1.0, 1.2, 1.2}, 0.5, 0, 0), 2)),
            0.5 * elsewhere);
  EXPECT_LT(distance(a, seen_from(room, pose_from_xyz_ypr({1.5, 1.6, 1.0}, 0.8, 0, 0), 3)),
            0.7 * elsewhere);
}

TEST(ScanDescriptor, OfNothingIsZero) {
  for (const float v : scan_descriptor(matching_scan({})).values) EXPECT_EQ(v, 0);
  Cloud few;
  few.points = {{1, 0, 0}, {1, 0.1f, 0}};
  for (const float v : scan_descriptor(matching_scan(few)).values) EXPECT_EQ(v, 0);
}

TEST(ScanDescriptor, RefusesTooFewSamples) {
  EXPECT_EQ(message_of([] { scan_descriptor(matching_scan({}), {.samples = 1}); }),
            "scan descriptor: samples must be >= 2, got 1");
}

TEST(SimilarScans, AreThoseOfBruteForce) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  std::vector<ScanDescriptor> descriptors(60);
  for (ScanDescriptor& d : descriptors)
    for (float& v : d.values) v = normal(random);
  const auto found = similar_scans(descriptors, 7);
  ASSERT_EQ(found.size(), descriptors.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::vector<double> distances;
    for (std::size_t k = 0; k < descriptors.size(); ++k)
      if (k != i) distances.push_back(distance(descriptors[i], descriptors[k]));
    std::sort(distances.begin(), distances.end());
    ASSERT_EQ(found[i].size(), 7u);
    for (std::size_t k = 0; k < 7; ++k) {
      EXPECT_NE(found[i][k].scan, i);
      EXPECT_NEAR(found[i][k].distance, distances[k], 1e-4);
    }
  }
}

TEST(SimilarScans, AreNoMoreThanThereAre) {
  EXPECT_TRUE(similar_scans({}, 5).empty());
  std::vector<ScanDescriptor> equal(3);
  const auto found = similar_scans(equal, 5);
  for (const auto& others : found) EXPECT_EQ(others.size(), 2u);
  EXPECT_TRUE(similar_scans(std::span(equal).first(1), 5).front().empty());
  EXPECT_TRUE(similar_scans(equal, 0).front().empty());
}

}  // namespace
}  // namespace planum
