#include "slam/sensor/range_limits.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

Cloud along_x(const std::vector<float>& ranges) {
  Cloud cloud;
  for (const float range : ranges) cloud.points.push_back({range, 0, 0});
  return cloud;
}

TEST(RangeLimits, SortsEveryPointIntoOneCount) {
  Cloud cloud = along_x({1, nan, 0.1f, 50, infinity, -2, 0});
  cloud.points.push_back({0, nan, 1});
  const ImportedScan result = limited(cloud, {.min_range = 0.3, .max_range = 30});
  EXPECT_EQ(result.counts.measured, 8u);
  EXPECT_EQ(result.counts.not_finite, 3u);
  EXPECT_EQ(result.counts.too_near, 2u);
  EXPECT_EQ(result.counts.too_far, 1u);
  EXPECT_EQ(result.counts.kept, 2u);
  EXPECT_EQ(result.source, (std::vector<std::uint32_t>{0, 5}));
  EXPECT_EQ(result.cloud.points[1], Eigen::Vector3f(-2, 0, 0));
}

TEST(RangeLimits, KeepsAttributesWithTheirPoints) {
  Cloud cloud = along_x({1, 100, 2});
  cloud.intensity = {10, 20, 30};
  cloud.scan = {4, 5, 6};
  cloud.normals = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(), Eigen::Vector3f::UnitZ()};
  const ImportedScan result = limited(cloud);
  EXPECT_EQ(result.cloud.intensity, (std::vector<float>{10, 30}));
  EXPECT_EQ(result.cloud.scan, (std::vector<std::uint32_t>{4, 6}));
  ASSERT_EQ(result.cloud.normals.size(), 2u);
  EXPECT_EQ(result.cloud.normals[1], Eigen::Vector3f::UnitZ());
}

TEST(RangeLimits, ALimitItselfIsWithin) {
  const RangeLimits limits{.min_range = 0.3, .max_range = 30};
  // As 30 cm and 3000 cm come out of a file in centimetres, and as floats.
  const Cloud cloud = along_x({0.3f, 0.29999998f, 30.0f, 30.000002f});
  EXPECT_EQ(limited(cloud, limits).counts.kept, 4u);
}

TEST(RangeLimits, ZeroMeansNoUpperLimit) {
  EXPECT_EQ(limited(along_x({1e6f}), {.max_range = 0}).counts.kept, 1u);
}

TEST(RangeLimits, RefusesLimitsThatLeaveNothing) {
  EXPECT_EQ(message_of([] { limited({}, {.min_range = 5, .max_range = 2}); }),
            "max_range_m is 2, must be above min_range_m = 5 (or 0: no limit)");
  EXPECT_EQ(message_of([] { limited({}, {.min_range = -1}); }),
            "min_range_m is -1, must be at least 0");
  EXPECT_EQ(message_of([] { limited({}, {.max_not_finite = 50}); }),
            "max_not_finite is 50, must be between 0 and 1");
}

TEST(CheckImport, AcceptsAScanUpToHalfNotFinite) {
  const ImportedScan half = limited(along_x({1, nan, 2, infinity}));
  EXPECT_EQ(half.counts.not_finite, 2u);
  EXPECT_NO_THROW(check_import(half.counts));
}

TEST(CheckImport, RefusesAScanMostlyNotFinite) {
  const ImportedScan scan = limited(along_x({1, nan, nan, infinity}));
  EXPECT_EQ(
      message_of([&] { check_import(scan.counts); }),
      "3 of 4 ranges are NaN or infinite (75.0 %, at most 50.0 % are allowed): the scan looks "
      "damaged; record or convert it again, or leave it out");
  EXPECT_NO_THROW(check_import(scan.counts, {.max_not_finite = 1}));
}

TEST(CheckImport, RefusesAnEmptyScan) {
  EXPECT_EQ(message_of([] { check_import(ImportCounts{}); }),
            "the scan is empty: it holds no measurement");
}

TEST(CheckImport, SaysWhereEverythingWent) {
  const ImportedScan scan = limited(along_x({0.1f, 0.2f, 3276, nan}));
  EXPECT_EQ(message_of([&] { check_import(scan.counts); }),
            "none of 4 measurements is left: 0 without return, 1 NaN or infinite, 2 nearer than "
            "min_range_m = 0.3, 1 farther than max_range_m = 30; check these limits and the unit "
            "of the file");
}

}  // namespace
}  // namespace planum
