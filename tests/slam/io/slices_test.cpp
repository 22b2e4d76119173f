#include "slam/io/slices.hpp"

#include <cmath>

#include "io_test_support.hpp"
#include "slam/core/pose.hpp"
#include "slam/io/uos.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_in_text;
using testing::TemporaryDirectory;
using testing::write_text;

RawScan scan_from(const std::string& text) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.slices", text);
  return read_slices(directory / "scan000.slices");
}

std::string error_from(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "scan000.slices", text, read_slices);
}

TEST(Slices, ReadHeaderAndRanges) {
  const RawScan scan = scan_from(
      "# first_beam_deg -90\n# step_deg 0.5\n# range_min 0.2 range_max 32\n"
      "# time_inc_s 0.001\n# mount_x_m 0.01\n# mount_z_m: -0.08\n# beams 3\n"
      "0.5 -45 1 2 3\n\n0.75\t45 4 5 6");
  EXPECT_DOUBLE_EQ(scan.laser.first_beam, -pi / 2);
  EXPECT_DOUBLE_EQ(scan.laser.beam_step, radians(0.5));
  EXPECT_EQ(scan.laser.min_range, 0.2);
  EXPECT_EQ(scan.laser.max_range, 32);
  EXPECT_EQ(scan.laser.beam_interval, 0.001);
  EXPECT_EQ(scan.laser.mount_x, 0.01);
  EXPECT_EQ(scan.laser.mount_z, -0.08);
  ASSERT_EQ(scan.slices.size(), 2u);
  EXPECT_EQ(scan.slices[0].time, 0.5);
  EXPECT_DOUBLE_EQ(scan.slices[0].tilt, -pi / 4);
  EXPECT_EQ(scan.slices[1].ranges, (std::vector<float>{4, 5, 6}));
}

TEST(Slices, HaveDefaultsWithoutAHeader) {
  const RawScan scan = scan_from("0 0 1 2\n");
  EXPECT_EQ(scan.laser.first_beam, -pi / 2);
  EXPECT_EQ(scan.laser.beam_step, 0);
  EXPECT_EQ(scan.laser.max_range, 0);
}

TEST(Slices, TakeRadiansAndPassOverProseAndUnknownKeys) {
  const RawScan scan = scan_from(
      "# robot 7 angle_min_rad -2 angle_inc_rad=0.01\n# measured with a range_min of about 1 m\n"
      "#range_max 5\n0 0 1 2\n");
  EXPECT_EQ(scan.laser.first_beam, -2);
  EXPECT_EQ(scan.laser.beam_step, 0.01);
  EXPECT_EQ(scan.laser.min_range, 0);
  EXPECT_EQ(scan.laser.max_range, 5);
}

TEST(Slices, KeepRangesThatAreNoReturns) {
  const RawScan scan = scan_from("0 0 nan inf -1 0 -inf 2\n");
  const auto& ranges = scan.slices[0].ranges;
  ASSERT_EQ(ranges.size(), 6u);
  EXPECT_TRUE(std::isnan(ranges[0]));
  EXPECT_EQ(ranges[1], HUGE_VALF);
  EXPECT_EQ(ranges[2], -1);
  EXPECT_EQ(ranges[3], 0);
  EXPECT_EQ(ranges[4], -HUGE_VALF);
}

TEST(Slices, SayWhereALineIsWrong) {
  EXPECT_EQ(error_from("# beams 3\n0 0 1 2 3\n0 1 1 2\n"),
            "FILE:3: expected 3 ranges as in line 2, got 2");
  EXPECT_EQ(error_from("0 0 1 2 3\n0 1 1 2 3 4\n"),
            "FILE:2: expected 3 ranges as in line 1, got 4");
  EXPECT_EQ(error_from("0 0 1 2 3\n0 1 1 2"), "FILE:2: expected 3 ranges as in line 1, got 2");
  EXPECT_EQ(error_from("# beams 4\n0 0 1 2 3\n"),
            "FILE:2: expected 4 ranges as the header says, got 3");
  EXPECT_EQ(error_from("0 0 1 two 3\n"), "FILE:1: expected a number, got \"two\"");
  EXPECT_EQ(error_from("0 0 1 2\n0\n"), "FILE:2: expected time, tilt and ranges, got 1 number");
  EXPECT_EQ(error_from("0 0 1\n"), "FILE:1: expected time, tilt and at least 2 ranges, got 1");
  EXPECT_EQ(error_from("0 nan 1 2\n"), "FILE:1: expected finite time and tilt, got 0 and nan");
  EXPECT_EQ(error_from("# step_deg half\n0 0 1 2\n"),
            "FILE:1: expected a finite number after step_deg, got \"half\"");
  EXPECT_EQ(error_from("# step_deg\n0 0 1 2\n"),
            "FILE:1: expected a finite number after step_deg, got the end of the line");
  EXPECT_EQ(error_from(""), "FILE: there are no slices in it");
  EXPECT_EQ(error_from("# step_deg 0.5\n"), "FILE: there are no slices in it");
}

TEST(Slices, ComeBackAsTheyWereWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(5);
  for (int round = 0; round < 20; ++round) {
    RawScan scan;
    if (round > 0)
      scan.laser = {.first_beam = draws.uniform(-pi, pi),
                    .beam_step = draws.uniform(0, 0.1),
                    .min_range = draws.uniform(0, 1),
                    .max_range = draws.uniform(5, 80),
                    .beam_interval = draws.uniform(0, 1e-3),
                    .mount_x = draws.uniform(-1, 1),
                    .mount_z = draws.uniform(-1, 1)};
    for (int i = 0; i < 10; ++i) {
      Slice slice = {draws.uniform(0, 2e9), draws.uniform(-2, 2), {}};
      for (int k = 0; k < 50; ++k)
        slice.ranges.push_back(static_cast<float>(draws.uniform(-1, 30)));
      slice.ranges[3] = HUGE_VALF;
      scan.slices.push_back(slice);
    }
    write_slices(directory / "scan000.slices", scan);
    const RawScan read = read_slices(directory / "scan000.slices");
    EXPECT_EQ(read.laser.first_beam, scan.laser.first_beam);
    EXPECT_EQ(read.laser.beam_step, scan.laser.beam_step);
    EXPECT_EQ(read.laser.min_range, scan.laser.min_range);
    EXPECT_EQ(read.laser.max_range, scan.laser.max_range);
    EXPECT_EQ(read.laser.beam_interval, scan.laser.beam_interval);
    EXPECT_EQ(read.laser.mount_x, scan.laser.mount_x);
    EXPECT_EQ(read.laser.mount_z, scan.laser.mount_z);
    ASSERT_EQ(read.slices.size(), scan.slices.size());
    for (std::size_t i = 0; i < scan.slices.size(); ++i) {
      EXPECT_EQ(read.slices[i].time, scan.slices[i].time);
      EXPECT_NEAR(read.slices[i].tilt, scan.slices[i].tilt, 1e-15);
      EXPECT_EQ(read.slices[i].ranges, scan.slices[i].ranges);
    }
  }
}

TEST(Slices, OfDifferentLengthsAreNotWritten) {
  const TemporaryDirectory directory;
  RawScan scan;
  scan.slices = {{0, 0, {1, 2}}, {0, 0, {1, 2, 3}}};
  EXPECT_NE(testing::error_of([&] { write_slices(directory / "a.slices", scan); }), "");
  EXPECT_FALSE(std::filesystem::exists(directory / "a.slices"));
}

TEST(Slices, OfTheCorridorAgreeWithItsUosScans) {
  PLANUM_SHARED_DATASET(corridor, "kurt3d_corridor");
  for (const std::string id : {"scan000", "scan001", "scan002"}) {
    const RawScan raw = read_slices(corridor / (id + ".slices"));
    const Cloud cloud = read_uos_scan(corridor / (id + ".3d"));
    ASSERT_EQ(raw.slices.size() * 360, cloud.points.size());
    double worst = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const Slice& slice = raw.slices[i / 360];
      ASSERT_EQ(slice.ranges.size(), 360u);
      const double azimuth =
          raw.laser.first_beam + raw.laser.beam_step * static_cast<double>(i % 360);
      const double range = slice.ranges[i % 360];
      if (range == 0) {
        // No return; the UOS file has the longest range of the scanner instead.
        EXPECT_GT(cloud.points[i].norm(), 32);
        continue;
      }
      const Eigen::Vector3d in_slice(range * std::cos(azimuth), range * std::sin(azimuth), 0);
      // Looking up turns forward to up: about -y.
      const Eigen::Vector3d expected =
          Eigen::AngleAxisd(-slice.tilt, Eigen::Vector3d::UnitY()) * in_slice;
      worst = std::max(worst, (expected - cloud.points[i].cast<double>()).norm());
    }
    EXPECT_LT(worst, 2e-4) << "m, " << id;
  }
}

TEST(Slices, OfTheRoomHaveItsHeader) {
  PLANUM_SHARED_DATASET(room, "hokuyo_room");
  const RawScan raw = read_slices(room / "scan000.slices");
  EXPECT_EQ(raw.slices.size(), 865u);
  EXPECT_EQ(raw.slices[0].ranges.size(), 681u);
  EXPECT_EQ(raw.laser.first_beam, -2.086214);
  EXPECT_EQ(raw.laser.mount_z, 0.08);
}

}  // namespace
}  // namespace planum
