#include "slam/io/scan_directory.hpp"

#include "io_test_support.hpp"
#include "slam/io/scan_poses.hpp"
#include "slam/io/uos.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::error_of;
using testing::TemporaryDirectory;
using testing::write_text;

const std::string identity_pose = "0 0 0\n0 0 0\n";

void make_files(const TemporaryDirectory& directory, const std::vector<std::string>& names) {
  for (const std::string& name : names) write_text(directory / name, "1 2 3\n");
}

/// The error message without the directory in front.
std::string listing_error(const TemporaryDirectory& directory, const std::string& format = "auto") {
  std::string message = error_of([&] { list_scans(directory.path(), format); });
  const std::string prefix = directory.path().string();
  EXPECT_TRUE(message.starts_with(prefix)) << message;
  return message.substr(prefix.size());
}

std::vector<std::string> ids(const ScanDirectory& directory) {
  std::vector<std::string> result;
  for (const ScanFile& scan : directory.scans) result.push_back(scan.id);
  return result;
}

TEST(ScanDirectory, ListsScansByNumberWithTheirPoses) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan10.3d", "scan9.3d", "scan1.3d", "scan9.pose", "notes.txt",
                         ".scan2.3d", "labels7.txt", "scan3.lab"});
  std::filesystem::create_directory(directory / "scan4.3d");
  const ScanDirectory listed = list_scans(directory.path());
  EXPECT_EQ(listed.format, ScanFormat::uos);
  EXPECT_EQ(listed.path, directory.path());
  EXPECT_EQ(ids(listed), (std::vector<std::string>{"scan1", "scan9", "scan10"}));
  EXPECT_EQ(listed.scans[1].number, 9);
  EXPECT_EQ(listed.scans[1].file, directory / "scan9.3d");
  EXPECT_EQ(listed.scans[1].pose_file, directory / "scan9.pose");
  EXPECT_TRUE(listed.scans[0].pose_file.empty());
  EXPECT_TRUE(listed.trajectories.empty());
}

TEST(ScanDirectory, RecognisesEveryFormat) {
  for (const auto& [name, format] :
       std::vector<std::pair<std::string, ScanFormat>>{{"scan000.3d", ScanFormat::uos},
                                                       {"scan000.slices", ScanFormat::slices},
                                                       {"cloud_000.PLY", ScanFormat::ply},
                                                       {"000.xyz", ScanFormat::xyz}}) {
    const TemporaryDirectory directory;
    make_files(directory, {name});
    EXPECT_EQ(list_scans(directory.path()).format, format);
    EXPECT_EQ(list_scans(directory.path(), planum::name(format)).format, format);
  }
}

TEST(ScanDirectory, TakesTextFilesThatLookLikeSlices) {
  const TemporaryDirectory directory;
  write_text(directory / "scan1.txt", "# step_deg 0.5\n0 0 1 2\n");
  std::string long_line = "0 0";
  for (int i = 0; i < 20; ++i) long_line += " 1.5";
  write_text(directory / "scan2.txt", "# by hand\n" + long_line + "\n");
  write_text(directory / "scan3.txt", "1 2 3\n");
  write_text(directory / "scan4.txt", "what 1 saw\n");
  write_text(directory / "scan5.txt", "");
  write_text(directory / "notes.txt", "# step_deg 0.5\n");
  const ScanDirectory listed = list_scans(directory.path());
  EXPECT_EQ(listed.format, ScanFormat::slices);
  EXPECT_EQ(ids(listed), (std::vector<std::string>{"scan1", "scan2"}));
}

TEST(ScanDirectory, TakesOtherEndingsForANamedFormat) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan1.txt", "scan2.dat", "scan3.asc", "scan4.pts", "scan5.xyz"});
  EXPECT_EQ(list_scans(directory.path(), "xyz").scans.size(), 5u);
  EXPECT_EQ(list_scans(directory.path(), "slices").scans.size(), 1u);
}

TEST(ScanDirectory, TakesASingleScanWithoutANumber) {
  const TemporaryDirectory directory;
  make_files(directory, {"hall.ply"});
  const ScanDirectory listed = list_scans(directory.path());
  EXPECT_EQ(ids(listed), std::vector<std::string>{"hall"});
  EXPECT_EQ(listed.scans[0].number, 0);
  make_files(directory, {"scan1.ply"});
  EXPECT_EQ(ids(list_scans(directory.path())), std::vector<std::string>{"scan1"});
}

TEST(ScanDirectory, NamesBothFormatsSideBySide) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan000.3d", "scan001.3d", "scan000.slices"});
  EXPECT_EQ(listing_error(directory),
            ": there are scans in 2 formats, uos (scan000.3d, ...) and slices (scan000.slices): "
            "choose with --format uos or --format slices");
  EXPECT_EQ(list_scans(directory.path(), "uos").scans.size(), 2u);
  EXPECT_EQ(list_scans(directory.path(), "slices").scans.size(), 1u);
}

TEST(ScanDirectory, NamesBothFilesOfOneNumber) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan001.3d", "scan1.3d", "scan2.3d"});
  EXPECT_EQ(listing_error(directory),
            ": scan001.3d and scan1.3d are both scan number 1: rename or remove one of them");
}

TEST(ScanDirectory, SaysWhatItLookedFor) {
  const TemporaryDirectory directory;
  make_files(directory, {"readme.txt"});
  EXPECT_EQ(listing_error(directory),
            ": there are no scans in it: looked for scan000.3d (uos), scan000.slices (slices), "
            "scan000.ply, scan000.xyz and so on; .txt, .dat, .asc and .pts files of points are "
            "read with --format xyz");
  EXPECT_EQ(listing_error(directory, "uos"),
            ": there are no scans in it: looked for scans of format uos");
  EXPECT_EQ(listing_error(directory, "bag"),
            ": unknown scan format \"bag\": expected auto, uos, slices, ply or xyz");
}

TEST(ScanDirectory, MustBeADirectory) {
  const TemporaryDirectory directory;
  make_files(directory, {"file"});
  const std::string missing = (directory / "absent").string();
  EXPECT_EQ(error_of([&] { list_scans(missing); }), missing + ": there is no such directory");
  const std::string file = (directory / "file").string();
  EXPECT_EQ(error_of([&] { list_scans(file); }), file + ": this is not a directory");
}

TEST(ScanDirectory, WantsUsableNumbersInNames) {
  const TemporaryDirectory directory;
  make_files(directory, {"hall.3d", "room.3d"});
  EXPECT_EQ(listing_error(directory),
            "/hall.3d: the names of scans must have a number in them, as in scan007.3d");
  const TemporaryDirectory large;
  make_files(large, {"scan99999999999.3d"});
  EXPECT_EQ(listing_error(large), "/scan99999999999.3d: the scan's number is too large");
}

TEST(ScanDirectory, ListsTheSharedScans) {
  PLANUM_SHARED_DATASET(classroom, "classroom");
  const ScanDirectory listed = list_scans(classroom);
  EXPECT_EQ(listed.format, ScanFormat::slices);
  EXPECT_EQ(listed.scans.size(), 12u);
  ASSERT_EQ(listed.trajectories.size(), 2u);
  EXPECT_EQ(listed.trajectories[0].filename(), "odometry.tum");
  PLANUM_SHARED_DATASET(corridor, "kurt3d_corridor");
  EXPECT_NE(error_of([&] { list_scans(corridor); }), "");
  EXPECT_EQ(list_scans(corridor, "slices").scans.size(), 3u);
  EXPECT_FALSE(list_scans(corridor, "slices").scans[2].pose_file.empty());
}

TEST(ScanPoses, PreferPoseFilesThenOdometryThenNone) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan1.3d", "scan2.3d"});
  write_text(directory / "truth.tum", "1 0 0 0 0 0 0 1\n2 5 0 0 0 0 0 1\n");
  const auto poses = [&] { return read_scan_poses(list_scans(directory.path())); };
  EXPECT_EQ(poses().source, "none");
  EXPECT_TRUE(poses().world_from_scan.empty());
  write_text(directory / "odometry.tum", "2 3 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n9 0 0 0 0 0 0 1\n");
  EXPECT_EQ(poses().source, (directory / "odometry.tum").string());
  EXPECT_EQ(poses().world_from_scan.at(1).translation().x(), 3);
  write_text(directory / "scan1.pose", identity_pose);
  write_text(directory / "scan2.pose", "0 0 400 0 0 0\n");
  EXPECT_EQ(poses().source, "pose files");
  EXPECT_EQ(poses().world_from_scan.at(1).translation().x(), 4);
  EXPECT_TRUE(read_scan_poses(list_scans(directory.path()), "none").world_from_scan.empty());
  const std::string truth = (directory / "truth.tum").string();
  EXPECT_EQ(
      read_scan_poses(list_scans(directory.path()), truth).world_from_scan.at(1).translation().x(),
      5);
}

TEST(ScanPoses, NameTheScanWithoutAPose) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan1.3d", "scan2.3d"});
  write_text(directory / "scan1.pose", identity_pose);
  const auto error = [&](const std::string& source) {
    return error_of([&] { read_scan_poses(list_scans(directory.path()), source); });
  };
  const std::string scan2 = (directory / "scan2.3d").string();
  EXPECT_EQ(error("auto"), scan2 +
                               ": there is no pose file scan2.pose beside it, though other scans "
                               "have theirs: add it or choose poses = \"none\"");
  const std::string tum = (directory / "a.tum").string();
  write_text(tum, "1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(error(tum), tum + ": there is no pose for number 2, which is " + scan2 +
                            " (the first column must be the scan's number)");
  write_text(tum, "1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(error(tum), tum + ": there are two poses for number 1");
  write_text(directory / "scan2.pose", "0 0 0\n1 2");
  EXPECT_NE(error("auto").find("scan2.pose:2: expected 6 numbers"), std::string::npos);
}

TEST(ScanPoses, ComeFromTheVerticesOfAGraph) {
  const TemporaryDirectory directory;
  make_files(directory, {"scan1.3d"});
  write_text(directory / "graph.g2o", "VERTEX_SE3:QUAT 1 1 2 3 0 0 0 1\n");
  const ScanPoses poses =
      read_scan_poses(list_scans(directory.path()), (directory / "graph.g2o").string());
  EXPECT_EQ(poses.world_from_scan.at(0).translation(), Eigen::Vector3d(1, 2, 3));
}

}  // namespace
}  // namespace planum
