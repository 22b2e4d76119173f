#include <cmath>

#include "io_test_support.hpp"
#include "slam/io/pose_list.hpp"
#include "slam/io/tum.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_in_text;
using testing::TemporaryDirectory;
using testing::text_of;
using testing::write_text;

std::string tum_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "a.tum", text, read_tum);
}

std::string list_error(const std::string& text) {
  const TemporaryDirectory directory;
  return error_in_text(directory / "poses.txt", text, read_pose_list);
}

TEST(Tum, ReadsPoses) {
  const TemporaryDirectory directory;
  write_text(directory / "a.tum", "# stamp x y z qx qy qz qw\n1305031.5 1 2 3 0 0 0.7071 0.7071\n");
  const Trajectory trajectory = read_tum(directory / "a.tum");
  ASSERT_EQ(trajectory.size(), 1u);
  EXPECT_EQ(trajectory[0].stamp, 1305031.5);
  EXPECT_EQ(trajectory[0].pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_LT(
      (trajectory[0].pose.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
      1e-9);
}

TEST(Tum, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(9);
  Trajectory written;
  for (int i = 0; i < 500; ++i)
    written.push_back({i < 250 ? i : draws.uniform(0, 2e9), draws.pose()});
  write_tum(directory / "a.tum", written);
  const Trajectory read = read_tum(directory / "a.tum");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp, written[i].stamp);
    EXPECT_EQ(read[i].pose.translation(), written[i].pose.translation());
    EXPECT_TRUE(read[i].pose.linear().isApprox(written[i].pose.linear(), 1e-14));
  }
}

TEST(Tum, IsWrittenAsDocumented) {
  const TemporaryDirectory directory;
  Pose pose(Eigen::AngleAxisd(-pi, Eigen::Vector3d::UnitZ()));
  pose.translation() = Eigen::Vector3d(0.1, -2, 1e-7);
  write_tum(directory / "a.tum", {{7, pose}, {8, Pose::Identity()}});
  const std::string text = text_of(directory / "a.tum");
  EXPECT_TRUE(text.starts_with("7 0.1 -2 1e-07 ")) << text;
  EXPECT_TRUE(text.ends_with("8 0 0 0 0 0 0 1\n")) << text;
}

TEST(Tum, SaysWhereALineIsWrong) {
  EXPECT_EQ(tum_error("0 0 0 0 0 0 0 1\n1 2 3 4 5\n"),
            "FILE:2: expected 8 numbers (stamp x y z qx qy qz qw), got 5");
  EXPECT_EQ(tum_error("0 0 0 0 0 0 0 1 5\n"),
            "FILE:1: expected 8 numbers (stamp x y z qx qy qz qw), but the line goes on with "
            "\"5\"");
  EXPECT_EQ(tum_error("scan000 0 0 0 0 0 0 1\n"), "FILE:1: expected a number, got \"scan000\"");
  EXPECT_EQ(tum_error("0 0 0 nan 0 0 0 1\n"), "FILE:1: expected finite numbers");
  EXPECT_EQ(tum_error("inf 0 0 0 0 0 0 1\n"), "FILE:1: expected a finite stamp");
  EXPECT_EQ(tum_error("0 0 0 0 0 0 0 0.5\n"),
            "FILE:1: expected a unit quaternion qx qy qz qw, got one of length 0.5");
  EXPECT_EQ(tum_error("\n# nothing\n"), "FILE: there are no poses in it");
}

TEST(PoseList, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(10);
  std::vector<Pose> written;
  for (int i = 0; i < 500; ++i) written.push_back(draws.pose());
  for (const double pitch : {-90.0, 90.0})
    written.push_back(pose_from_xyz_ypr({1, 2, 3}, 0.5, radians(pitch), 0.25));
  write_pose_list(directory / "poses.txt", written);
  const std::vector<Pose> read = read_pose_list(directory / "poses.txt");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_TRUE(read[i].isApprox(written[i], 1e-12));
}

TEST(PoseList, TurnsLeftNoseDownAndRightSideDown) {
  const TemporaryDirectory directory;
  write_text(directory / "poses.txt", "0 0 0 90 0 0\n0 0 0 0 90 0\n0 0 0 0 0 90\n");
  const auto poses = read_pose_list(directory / "poses.txt");
  ASSERT_EQ(poses.size(), 3u);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  EXPECT_LT((poses[0] * x - y).norm(), 1e-12);
  EXPECT_LT((poses[1] * x + z).norm(), 1e-12);
  EXPECT_LT((poses[2] * y - z).norm(), 1e-12);
}

TEST(PoseList, SaysWhereALineIsWrong) {
  EXPECT_EQ(list_error("0 0 0 0 0 0\n1 2 3 4\n"),
            "FILE:2: expected 6 numbers (x y z yaw pitch roll), got 4");
  EXPECT_EQ(list_error("0 0 0 0 inf 0\n"), "FILE:1: expected finite numbers");
  EXPECT_EQ(list_error(""), "FILE: there are no poses in it");
}

TEST(PoseList, OfTheClassroomAgreesWithItsTrajectory) {
  PLANUM_SHARED_DATASET(classroom, "classroom");
  const auto poses = read_pose_list(classroom / "true_poses.txt");
  const Trajectory truth = read_tum(classroom / "truth.tum");
  ASSERT_EQ(poses.size(), 12u);
  ASSERT_EQ(truth.size(), 12u);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose relative = poses[0].inverse() * poses[i];
    EXPECT_LT((relative.translation() - truth[i].pose.translation()).norm(), 1e-6) << i;
    EXPECT_LT(rotation_angle(relative, truth[i].pose), 1e-6) << i;
  }
}

}  // namespace
}  // namespace planum
