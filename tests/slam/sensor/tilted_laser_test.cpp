#include "slam/sensor/tilted_laser.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/kd_tree.hpp"
#include "slam/core/plane.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/slices.hpp"
#include "slam/io/uos.hpp"
#include "tests/slam/sensor/sensor_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

constexpr RangeLimits all{.min_range = 0, .max_range = 0};
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

RawScan scan_of(const TiltedLaser& laser, std::vector<Slice> slices) {
  return {.laser = laser, .slices = std::move(slices)};
}

void expect_near(const Eigen::Vector3f& a, const Eigen::Vector3d& b, double tolerance = 1e-6) {
  EXPECT_LT((a.cast<double>() - b).norm(), tolerance) << a.transpose() << " / " << b.transpose();
}

TEST(TiltedLaser, BeamsRunFromRightToLeft) {
  const auto points = points_from_slices(scan_of({}, {{0, 0, {2, 3, 4}}}), all).cloud.points;
  ASSERT_EQ(points.size(), 3u);
  expect_near(points[0], {0, -2, 0});
  expect_near(points[1], {3, 0, 0});
  expect_near(points[2], {0, 4, 0});
}

TEST(TiltedLaser, PositiveTiltLooksUp) {
  const auto points =
      points_from_slices(scan_of({}, {{0, radians(30), {2, 2, 2}}}), all).cloud.points;
  expect_near(points[0], {0, -2, 0});  // along the tilt axis
  expect_near(points[1], {std::sqrt(3.0), 0, 1});
}

TEST(TiltedLaser, HeaderGivesAzimuths) {
  const TiltedLaser laser{.first_beam = radians(10), .beam_step = radians(20)};
  const auto points = points_from_slices(scan_of(laser, {{0, 0, {1, 1}}}), all).cloud.points;
  expect_near(points[0], {std::cos(radians(10)), std::sin(radians(10)), 0});
  expect_near(points[1], {std::cos(radians(30)), std::sin(radians(30)), 0});
}

TEST(TiltedLaser, MirrorGoesRoundTheTiltAxis) {
  const TiltedLaser laser{.mount_x = 0.1, .mount_z = 0.08};
  const RawScan scan = scan_of(laser, {{0, 0, {1, 1, 1}}, {1, radians(90), {1, 1, 1}}});
  const auto points = points_from_slices(scan, all).cloud.points;
  expect_near(points[1], {1.1, 0, 0.08});
  expect_near(points[4], {-0.08, 0, 1.1});
  expect_near(points[3], {-0.08, -1, 0.1});
}

TEST(TiltedLaser, MeasuresRandomPointsWhereTheyAre) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const double azimuth = 1.5 * unit(random), tilt = 1.4 * unit(random), range = 3 + unit(random);
    const TiltedLaser laser{.first_beam = azimuth,
                            .beam_step = 1,
                            .mount_x = 0.1 * unit(random),
                            .mount_z = 0.1 * unit(random)};
    const RawScan scan = scan_of(laser, {{0, tilt, {static_cast<float>(range)}}});
    // Forward and up within the slice plane, each turned up by the tilt.
    const Eigen::Vector3d forward(std::cos(tilt), 0, std::sin(tilt));
    const Eigen::Vector3d up(-std::sin(tilt), 0, std::cos(tilt));
    const Eigen::Vector3d truth = (laser.mount_x + range * std::cos(azimuth)) * forward +
                                  laser.mount_z * up +
                                  range * std::sin(azimuth) * Eigen::Vector3d::UnitY();
    expect_near(points_from_slices(scan, all).cloud.points.at(0), truth, 2e-6);
  }
}

TEST(TiltedLaser, TiltOfABeamLiesBetweenItsSliceAndTheNext) {
  const TiltedLaser laser{.first_beam = 0, .beam_step = 1e-9, .beam_interval = 0.25};
  const RawScan scan = scan_of(laser, {{10, 0, {1, 1, 1}}, {11, 0.4, {1, 1, 1}}});
  const auto points = points_from_slices(scan, all).cloud.points;
  for (int beam = 0; beam < 3; ++beam) {
    const double tilt = 0.1 * beam;
    expect_near(points[static_cast<std::size_t>(beam)], {std::cos(tilt), 0, std::sin(tilt)});
    // The last slice goes on as fast.
    const double last = 0.4 + tilt;
    expect_near(points[static_cast<std::size_t>(3 + beam)], {std::cos(last), 0, std::sin(last)});
  }
}

TEST(TiltedLaser, TiltStandsStillWhereTimeDoes) {
  const std::vector<double> rates = tilt_rates({{5, 0, {}}, {5, 1, {}}, {6, 2, {}}, {4, 3, {}}});
  EXPECT_EQ(rates, (std::vector<double>{0, 1, 0, 0}));
  EXPECT_EQ(tilt_rates({{1, 2, {}}}), std::vector<double>{0});
}

TEST(TiltedLaser, CountsWhatItDrops) {
  const TiltedLaser laser{.min_range = 0.05, .max_range = 8};
  const float inf = std::numeric_limits<float>::infinity();
  const RawScan scan = scan_of(laser, {{0, 0, {0, -1, nan, inf, -inf, 0.01f, 9, 0.1f, 7, 1, 8}}});
  const ImportedScan result = points_from_slices(scan, {.min_range = 0.3, .max_range = 6});
  EXPECT_EQ(result.counts.measured, 11u);
  EXPECT_EQ(result.counts.no_return, 4u);
  EXPECT_EQ(result.counts.not_finite, 3u);
  EXPECT_EQ(result.counts.too_near, 1u);
  EXPECT_EQ(result.counts.too_far, 2u);
  EXPECT_EQ(result.counts.kept, 1u);
  EXPECT_EQ(result.source, std::vector<std::uint32_t>{9});
}

TEST(TiltedLaser, RefusesHeadersAndTiltsThatAreNoNumbers) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto message = [](const TiltedLaser& laser, double tilt) {
    return message_of([&] { points_from_slices(scan_of(laser, {{0, 0, {1}}, {1, tilt, {1}}})); });
  };
  EXPECT_EQ(message({}, not_a_number), "slice 1: its tilt is nan, must be a finite number");
  EXPECT_EQ(message({.mount_z = not_a_number}, 0),
            "mount_z_m of the laser is nan, must be a finite number");
  EXPECT_EQ(message({.beam_interval = -1}, 0), "time_inc_s of the laser is -1, must be at least 0");
  EXPECT_EQ(message({.min_range = 5, .max_range = 4}, 0),
            "range_max of the laser is 4, must be above range_min = 5");
}

TEST(TiltedLaser, SlicesGiveTheScanThatTheyWereUnrolledFrom) {
  PLANUM_SHARED_DATASET(data, "kurt3d_corridor");
  for (const char* id : {"scan000", "scan001", "scan002"}) {
    const Cloud uos = read_uos_scan(data / (std::string(id) + ".3d"));
    const ImportedScan rolled =
        points_from_slices(read_slices(data / (std::string(id) + ".slices")));
    const ImportedScan direct = limited(uos);
    ASSERT_EQ(rolled.counts.measured, uos.points.size());
    // The same points are used, whichever file they come from.
    ASSERT_EQ(rolled.source, direct.source) << id;
    float worst = 0;
    for (std::size_t i = 0; i < rolled.cloud.points.size(); ++i)
      worst = std::max(worst, (rolled.cloud.points[i] - direct.cloud.points[i]).norm());
    EXPECT_LT(worst, 1e-3f) << id;
    RecordProperty(std::string(id) + "_worst_m", std::to_string(worst));
  }
}

/// Median distance of every 50th point of a sweep from the planes that its neighbours in the other
/// one lie in.
double median_distance(const std::vector<Eigen::Vector3f>& sweep,
                       const std::vector<Eigen::Vector3f>& other) {
  const KdTree tree(other);
  std::vector<Neighbour> neighbours;
  std::vector<double> distances;
  for (std::size_t i = 0; i < sweep.size(); i += 50) {
    tree.within(sweep[i], 0.1f, neighbours);
    PointMoments moments;
    for (const Neighbour& n : neighbours) moments.add((other[n.index] - sweep[i]).cast<double>());
    const auto fit = fit_plane(moments);
    if (!fit || neighbours.size() < 10 || fit->variances[1] < 1e-4) continue;
    distances.push_back(std::abs(fit->plane.offset));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

TEST(TiltedLaser, SweepsDownAndUpAgree) {
  PLANUM_SHARED_DATASET(data, "hokuyo_room");
  const RawScan scan = read_slices(data / "scan000.slices");
  const ImportedScan points = points_from_slices(scan);
  EXPECT_NO_THROW(check_import(points.counts));
  // It nods down first.
  std::size_t lowest = 0;
  for (std::size_t s = 0; s < scan.slices.size(); ++s)
    if (scan.slices[s].tilt < scan.slices[lowest].tilt) lowest = s;
  const std::size_t turning_point = lowest * scan.slices.front().ranges.size();
  std::vector<Eigen::Vector3f> down, up;
  for (std::size_t i = 0; i < points.source.size(); ++i)
    (points.source[i] < turning_point ? down : up).push_back(points.cloud.points[i]);
  const double median = median_distance(up, down);
  EXPECT_LT(median, 0.007);
  RecordProperty("median_m", std::to_string(median));
}

}  // namespace
}  // namespace planum
