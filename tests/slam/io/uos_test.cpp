#include "slam/io/uos.hpp"

#include <cmath>

#include "io_test_support.hpp"
#include "slam/io/frames.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_in_text;
using testing::TemporaryDirectory;
using testing::text_of;
using testing::write_text;

std::string scan_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "scan000.3d", text, read_uos_scan);
}

std::string pose_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "scan000.pose", text, read_uos_pose);
}

TEST(UosScan, TurnsCentimetresRightUpForwardIntoMetresForwardLeftUp) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.3d", "100 200 300\n-1 0 0.5\n");
  const Cloud cloud = read_uos_scan(directory / "scan000.3d");
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(3, -1, 2));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(0.005f, 0.01f, 0));
  EXPECT_TRUE(cloud.intensity.empty());
}

TEST(UosScan, TakesASizeLineAndIntensities) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.3d", "2 x 1\r\n100 200 300 0.5 7 8\r\n1 2 3 0.25 x y");
  const Cloud cloud = read_uos_scan(directory / "scan000.3d");
  EXPECT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.intensity, (std::vector<float>{0.5f, 0.25f}));
}

TEST(UosScan, KeepsPointsThatAreNotFinite) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.3d", "nan 1 2\n1 inf 2\n1 2 3\n");
  const Cloud cloud = read_uos_scan(directory / "scan000.3d");
  ASSERT_EQ(cloud.points.size(), 3u);
  EXPECT_TRUE(std::isnan(cloud.points[0].y()));
  EXPECT_EQ(cloud.points[0].x(), 0.02f);
  EXPECT_EQ(cloud.points[1].z(), HUGE_VALF);
}

TEST(UosScan, SaysWhereALineIsWrong) {
  EXPECT_EQ(scan_error("1 2 3\n4 5\n"), "FILE:2: expected 3 numbers, got 2");
  EXPECT_EQ(scan_error("1 2 3\n4 5 six\n"), "FILE:2: expected a number, got \"six\"");
  EXPECT_EQ(scan_error("1 2 3 4\n\n1 2 3\n"), "FILE:3: expected 4 numbers as in line 1, got 3");
  EXPECT_EQ(scan_error("1 2 3\n2 x 1\n"), "FILE:2: expected a number, got \"x\"");
  EXPECT_EQ(scan_error("x y z\n1 2 3\n"), "FILE:1: expected a number, got \"x\"");
  EXPECT_EQ(scan_error(""), "FILE: there are no points in it");
  EXPECT_EQ(scan_error("# nothing\n"), "FILE: there are no points in it");
  EXPECT_EQ(scan_error("0 x 1\n"), "FILE: there are no points in it");
}

TEST(UosScan, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(1);
  Cloud cloud;
  for (int i = 0; i < 5000; ++i) {
    const double size = std::pow(10, draws.uniform(-4, 3));
    cloud.points.push_back(draws.vector(size).cast<float>());
    cloud.intensity.push_back(static_cast<float>(draws.uniform(0, 1)));
  }
  write_uos_scan(directory / "scan000.3d", cloud);
  const Cloud read = read_uos_scan(directory / "scan000.3d");
  EXPECT_EQ(read.points, cloud.points);
  EXPECT_EQ(read.intensity, cloud.intensity);
}

/// R = Rx Ry Rz with the matrices written out, as 3DTK multiplies them.
Eigen::Matrix3d explicit_rotation(double x, double y, double z) {
  Eigen::Matrix3d rx, ry, rz;
  rx << 1, 0, 0, 0, std::cos(x), -std::sin(x), 0, std::sin(x), std::cos(x);
  ry << std::cos(y), 0, std::sin(y), 0, 1, 0, -std::sin(y), 0, std::cos(y);
  rz << std::cos(z), -std::sin(z), 0, std::sin(z), std::cos(z), 0, 0, 0, 1;
  return rx * ry * rz;
}

TEST(UosPose, MovesPointsAsInUosCoordinates) {
  const TemporaryDirectory directory;
  testing::Draws draws(2);
  const auto in_metres = [](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p.z() / 100, -p.x() / 100, p.y() / 100);
  };
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d t = draws.vector(1000), angles = draws.vector(180);
    write_text(directory / "scan000.pose",
               std::to_string(t.x()) + " " + std::to_string(t.y()) + " " + std::to_string(t.z()) +
                   "\n" + std::to_string(angles.x()) + " " + std::to_string(angles.y()) + " " +
                   std::to_string(angles.z()) + "\n");
    const Pose world_from_scan = read_uos_pose(directory / "scan000.pose");
    const Eigen::Vector3d p = draws.vector(500);
    const Eigen::Vector3d moved =
        explicit_rotation(radians(angles.x()), radians(angles.y()), radians(angles.z())) * p + t;
    // std::to_string has six decimals.
    EXPECT_LT((world_from_scan * in_metres(p) - in_metres(moved)).norm(), 1e-6);
    EXPECT_NEAR(world_from_scan.linear().determinant(), 1, 1e-12);
  }
}

TEST(UosPose, TurnsToTheRightAboutUp) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.pose", "0 0 100 0 90 0");
  const Pose pose = read_uos_pose(directory / "scan000.pose");
  EXPECT_LT((pose.translation() - Eigen::Vector3d(1, 0, 0)).norm(), 1e-12);
  // Ry(90) takes z_uos (forward) to x_uos (right).
  EXPECT_LT((pose.linear() * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(UosPose, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(3);
  const auto expect_same = [&](const Pose& pose) {
    write_uos_pose(directory / "scan000.pose", pose);
    const Pose read = read_uos_pose(directory / "scan000.pose");
    EXPECT_TRUE(read.isApprox(pose, 1e-12)) << text_of(directory / "scan000.pose");
  };
  for (int i = 0; i < 50; ++i) expect_same(draws.pose());
  for (const double y : {-90.0, 90.0}) {
    Pose locked = Pose::Identity();
    Eigen::Matrix4d uos = Eigen::Matrix4d::Identity();
    uos.topLeftCorner<3, 3>() = explicit_rotation(0.3, radians(y), 0.8);
    locked = pose_from_uos(uos);
    expect_same(locked);
  }
}

TEST(UosPose, WantsSixFiniteNumbers) {
  EXPECT_EQ(pose_error("1 2 3\n4 5\n"),
            "FILE:2: expected 6 numbers (x y z in cm, three angles in degrees), but the file ends "
            "after 5");
  EXPECT_EQ(pose_error("1 2 3\n4 5 6 7\n"),
            "FILE:2: expected 6 numbers in all, but there are more");
  EXPECT_EQ(pose_error("1 2 3\n4 5 nan\n"), "FILE:2: expected finite numbers");
  EXPECT_EQ(pose_error("1 2 3\n4 5 x\n"), "FILE:2: expected a number, got \"x\"");
  EXPECT_NE(pose_error(""), "");
  EXPECT_EQ(pose_error("1 2\n3 4 5 6\n\n"), "");
}

TEST(Frames, ComeBackAsTheyWereWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(4);
  std::vector<Frame> frames;
  for (int i = 0; i < 50; ++i) frames.push_back({draws.pose(), FrameKind(i % 4)});
  write_frames(directory / "scan000.frames", frames);
  const std::vector<Frame> read = read_frames(directory / "scan000.frames");
  ASSERT_EQ(read.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(read[i].world_from_scan.isApprox(frames[i].world_from_scan, 1e-12));
    EXPECT_EQ(read[i].kind, frames[i].kind);
  }
}

TEST(Frames, HoldTheMatrixOfUosByColumns) {
  const TemporaryDirectory directory;
  const Pose pose(Eigen::Translation3d(3, -1, 2));
  write_frames(directory / "scan000.frames", std::vector<Frame>{{pose, FrameKind::lum}});
  EXPECT_EQ(text_of(directory / "scan000.frames"), "1 0 0 0 0 1 0 0 0 0 1 0 100 200 300 1 3\n");
}

TEST(Frames, SayWhereALineIsWrong) {
  const TemporaryDirectory directory;
  const auto error = [&](const std::string& text) {
    return error_in_text(directory / "scan000.frames", text, read_frames);
  };
  EXPECT_EQ(error("1 0 0\n"),
            "FILE:1: expected 17 numbers (a 4 x 4 matrix by columns and the kind of frame), got 3");
  EXPECT_EQ(error("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 1\n"),
            "FILE:1: the matrix is not a rigid transform");
  EXPECT_EQ(error(""), "FILE: there are no frames in it");
}

TEST(UosScan, ReadsTheCorridor) {
  PLANUM_SHARED_DATASET(corridor, "kurt3d_corridor");
  const Cloud cloud = read_uos_scan(corridor / "scan000.3d");
  ASSERT_EQ(cloud.points.size(), 81360u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(0, -0.101f, 0));
  const Pose pose = read_uos_pose(corridor / "scan001.pose");
  EXPECT_LT((pose.translation() - Eigen::Vector3d(1.56917, 0.0310605, -0.0750803)).norm(), 1e-9);
  // Angles in the file: x 1.35694 (nose down in UOS terms), y -0.852409 (to the left), z -0.56224.
  EXPECT_NEAR(std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)), radians(0.852409), 2e-4);
}

}  // namespace
}  // namespace planum
