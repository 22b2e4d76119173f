#include "slam/sensor/simulator.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "slam/sensor/building.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

constexpr RangeLimits all{.min_range = 0, .max_range = 0};
const Eigen::Vector3d room_size(5, 4, 3);
const Pose in_the_room = pose_from_xyz_ypr({1.7, 1.9, 1.2}, 0.3, 0.02, -0.03);

BuildingPlan box_room() {
  return {.rooms = {{.name = "box",
                     .walls = {.outer = {{0, 0}, {5, 0}, {5, 4}, {0, 4}}},
                     .height = room_size.z()}}};
}

/// With a pillar of 0.4 m x 0.4 m in front of the scanner.
BuildingPlan room_with_pillar() {
  BuildingPlan plan = box_room();
  plan.rooms[0].walls.holes = {{{3, 2}, {3.4, 2}, {3.4, 2.4}, {3, 2.4}}};
  return plan;
}

SimulatorParams faultless() {
  return {.beams = 181,
          .slices = 91,
          .range_noise = 0,
          .drop_out = 0,
          .grazing_drop_out = 0,
          .mixed_pixel = 0};
}

SimulatedScan simulated(const BuildingPlan& plan, const SimulatorParams& params,
                        std::uint64_t number = 0) {
  return simulate_scan(RayCaster(built(plan).mesh.mesh), in_the_room, number, params);
}

std::vector<float> ranges(const SimulatedScan& scan) {
  std::vector<float> all_ranges;
  for (const Slice& slice : scan.scan.slices)
    all_ranges.insert(all_ranges.end(), slice.ranges.begin(), slice.ranges.end());
  return all_ranges;
}

/// How far a point is from the nearest face of the room.
double distance_from_box(const Eigen::Vector3d& p) {
  double nearest = 100;
  for (int axis = 0; axis < 3; ++axis)
    nearest = std::min({nearest, std::abs(p[axis]), std::abs(p[axis] - room_size[axis])});
  return nearest;
}

TEST(Simulator, FaultlessReturnsLieOnTheWalls) {
  SimulatorParams params = faultless();
  for (const bool nodding_mirror : {false, true}) {
    if (nodding_mirror) {
      params.laser.mount_x = 0.05;
      params.laser.mount_z = 0.08;
      params.laser.beam_interval = 1e-4;
    }
    const SimulatedScan scan = simulated(box_room(), params);
    const ImportedScan points = points_from_slices(scan.scan, all);
    EXPECT_EQ(points.counts.kept, params.beams * params.slices);
    double worst = 0;
    for (const Eigen::Vector3f& p : points.cloud.points)
      worst = std::max(worst, distance_from_box(in_the_room * p.cast<double>()));
    EXPECT_LT(worst, 1e-4);
  }
}

TEST(Simulator, SaysWhatEachBeamHit) {
  const LabelledMesh mesh = built(box_room()).mesh;
  const SimulatedScan scan = simulated(box_room(), faultless());
  const ImportedScan points = points_from_slices(scan.scan, all);
  std::size_t floor = 0, ceiling = 0;
  for (std::size_t i = 0; i < points.source.size(); ++i) {
    const std::string& name = mesh.names[mesh.group[scan.triangle[points.source[i]]]];
    const double z = (in_the_room * points.cloud.points[i].cast<double>()).z();
    if (name == "floor") {
      EXPECT_NEAR(z, 0, 1e-4);
      ++floor;
    } else if (name == "ceiling") {
      EXPECT_NEAR(z, room_size.z(), 1e-4);
      ++ceiling;
    } else {
      EXPECT_EQ(name, "wall");
    }
  }
  EXPECT_GT(floor, 1000u);
  EXPECT_GT(ceiling, 1000u);
}

TEST(Simulator, SlicesCoverTheTiltsAndTimes) {
  const RawScan scan = simulated(box_room(), faultless()).scan;
  EXPECT_EQ(scan.slices.size(), 91u);
  EXPECT_DOUBLE_EQ(scan.slices.front().tilt, radians(-55));
  EXPECT_NEAR(scan.slices.back().tilt, radians(70), 1e-12);
  EXPECT_NEAR(scan.slices.back().time, 90 * 0.0267, 1e-12);
}

TEST(Simulator, RangeNoiseHasItsDeviation) {
  SimulatorParams params = faultless();
  const std::vector<float> truth = ranges(simulated(box_room(), params));
  params.range_noise = 0.02;
  const std::vector<float> noisy = ranges(simulated(box_room(), params));
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double error = static_cast<double>(noisy[i] - truth[i]);
    sum += error;
    squares += error * error;
  }
  const double n = static_cast<double>(truth.size());
  EXPECT_NEAR(sum / n, 0, 4 * 0.02 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.0005);
}

TEST(Simulator, DropsOutAtItsRate) {
  SimulatorParams params = faultless();
  params.drop_out = 0.1;
  const ImportCounts counts = points_from_slices(simulated(box_room(), params).scan, all).counts;
  const double n = static_cast<double>(counts.measured);
  EXPECT_NEAR(static_cast<double>(counts.no_return) / n, 0.1, 4 * std::sqrt(0.09 / n));
}

TEST(Simulator, LosesMoreAtGrazingIncidence) {
  // Along the walls of a tunnel; the far end is beyond reach.
  const BuildingPlan tunnel{.rooms = {{.name = "tunnel",
                                       .walls = {.outer = {{-1, -1}, {90, -1}, {90, 1}, {-1, 1}}},
                                       .height = 2}}};
  const RayCaster caster(built(tunnel).mesh.mesh);
  SimulatorParams params = faultless();
  params.laser.first_beam = radians(-45);
  params.laser.max_range = 80;
  params.grazing_drop_out = 0.5;
  params.slices = 2000;
  params.min_tilt = 0;
  params.max_tilt = 1e-9;
  const RawScan scan = simulate_scan(caster, pose_from_xyz_ypr({0, 0, 1}, 0, 0, 0), 0, params).scan;
  const auto lost = [&](double azimuth) {
    const double step = pi / 180;
    const auto beam = static_cast<std::size_t>(std::lround((azimuth + pi / 4) / step));
    double count = 0;
    for (const Slice& slice : scan.slices) count += slice.ranges[beam] == 0;
    return count / static_cast<double>(scan.slices.size());
  };
  EXPECT_EQ(lost(radians(11)), 0);
  const double at_5_degrees = 0.5 * (1 - std::sin(radians(5)) / std::sin(radians(10)));
  EXPECT_NEAR(lost(radians(5)), at_5_degrees, 0.04);
  EXPECT_NEAR(lost(radians(-5)), at_5_degrees, 0.04);
}

TEST(Simulator, MixedPixelsLieBetweenTheSurfaces) {
  SimulatorParams params = faultless();
  params.slices = 181;
  const std::vector<float> truth = ranges(simulated(room_with_pillar(), params));
  params.mixed_pixel = 1;
  const SimulatedScan mixed = simulated(room_with_pillar(), params);
  const std::vector<float> blended = ranges(mixed);
  int found = 0, in_the_middle = 0;
  for (std::size_t s = 1; s + 1 < params.slices; ++s)
    for (std::size_t b = 1; b + 1 < params.beams; ++b) {
      const std::size_t i = s * params.beams + b;
      if (mixed.triangle[i] != no_triangle) {
        EXPECT_EQ(blended[i], truth[i]);
        continue;
      }
      float nearest = truth[i], farthest = truth[i];
      for (const std::size_t row : {i - params.beams, i, i + params.beams})
        for (std::size_t k = row - 1; k <= row + 1; ++k) {
          nearest = std::min(nearest, truth[k]);
          farthest = std::max(farthest, truth[k]);
        }
      ++found;
      EXPECT_GE(blended[i], nearest - 0.02f);
      EXPECT_LE(blended[i], farthest + 0.02f);
      in_the_middle += blended[i] > nearest + 0.2f && blended[i] < farthest - 0.2f;
    }
  EXPECT_GT(found, 50);
  EXPECT_GT(in_the_middle, found / 3);

  params.mixed_pixel = 0.25;
  const SimulatedScan fewer = simulated(room_with_pillar(), params);
  const auto rest = std::count(fewer.triangle.begin(), fewer.triangle.end(), no_triangle);
  EXPECT_NEAR(static_cast<double>(rest), 0.25 * found, 12);
}

TEST(Simulator, SlantedWallsAndCornersDoNotMix) {
  SimulatorParams params = faultless();
  params.mixed_pixel = 1;
  const SimulatedScan scan = simulated(box_room(), params);
  EXPECT_EQ(std::count(scan.triangle.begin(), scan.triangle.end(), no_triangle), 0);
}

TEST(Simulator, NothingComesBackFromOutOfReach) {
  SimulatorParams params = faultless();
  params.laser.max_range = 2;
  for (const float range : ranges(simulated(box_room(), params))) EXPECT_LE(range, 2);
  EXPECT_GT(points_from_slices(simulated(box_room(), params).scan, all).counts.no_return, 1000u);
}

TEST(Simulator, IsTheSameOnAnyNumberOfThreads) {
  const SimulatorParams params{.beams = 181, .slices = 91};
  const auto scan = [&] { return simulated(room_with_pillar(), params); };
  const SimulatedScan one = with_threads(1, scan), many = with_threads(4, scan);
  EXPECT_EQ(ranges(one), ranges(many));
  EXPECT_EQ(one.triangle, many.triangle);
}

TEST(Simulator, SeedAndNumberMakeScansDifferent) {
  SimulatorParams params{.beams = 61, .slices = 31};
  const auto first = ranges(simulated(box_room(), params, 0));
  EXPECT_EQ(first, ranges(simulated(box_room(), params, 0)));
  EXPECT_NE(first, ranges(simulated(box_room(), params, 1)));
  params.seed = 2;
  EXPECT_NE(first, ranges(simulated(box_room(), params, 0)));
}

TEST(Simulator, ScansOfAPathAreNumberedInOrder) {
  const TriangleMesh mesh = built(box_room()).mesh.mesh;
  const SimulatorParams params{.beams = 61, .slices = 31};
  std::vector<std::size_t> steps;
  const auto scans = simulate_scans(mesh, std::vector<Pose>{in_the_room, in_the_room}, params,
                                    Progress([&](std::size_t done, std::size_t total) {
                                      steps.push_back(done);
                                      EXPECT_EQ(total, 2u);
                                    }));
  EXPECT_EQ(steps, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(ranges(scans[1]), ranges(simulated(box_room(), params, 1)));
}

TEST(Simulator, RefusesParametersOutOfRange) {
  const auto message = [](const SimulatorParams& params) {
    return message_of([&] { simulated(box_room(), params); });
  };
  EXPECT_EQ(message({.beams = 1}), "beams is 1, must be at least 2");
  EXPECT_EQ(message({.drop_out = 1.5}), "drop_out is 1.5, must be between 0 and 1");
  EXPECT_EQ(message({.range_noise = -1}), "range_noise_m is -1, must be between 0 and 10");
  EXPECT_EQ(message({.min_tilt = radians(30), .max_tilt = radians(-30)}),
            "max_tilt_deg is -30, must be between 30 and 180");
}

}  // namespace
}  // namespace planum
