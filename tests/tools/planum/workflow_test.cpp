#include <map>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/tools/planum/small_project.hpp"

namespace planum::testing {
namespace {

/// report.json without what depends on the clock and on what was done in this run.
std::string timeless(const std::string& report) {
  auto json = nlohmann::json::parse(report);
  json.erase("stages");
  json.erase("threads");
  return json.dump();
}

/// The same bytes in all files.
void expect_same_results(const std::map<std::string, std::string>& expected,
                         const std::map<std::string, std::string>& found) {
  for (const auto& [name, text] : expected) {
    ASSERT_TRUE(found.contains(name)) << name << " is missing";
    if (name == "report.json") {
      EXPECT_EQ(timeless(found.at(name)), timeless(text)) << name;
    } else {
      EXPECT_TRUE(found.at(name) == text) << name << " differs";
    }
  }
  EXPECT_EQ(found.size(), expected.size());
}

class Workflow : public ::testing::Test {
 protected:
  /// The project with its results, made once for all tests.
  static const std::filesystem::path& finished() {
    static const TemporaryDirectory directory;
    static const bool made = [] {
      write_small_project(directory.path());
      const Outcome outcome = Program(directory.path())({"run", "--threads", "2"});
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      return true;
    }();
    EXPECT_TRUE(made);
    return directory.path();
  }

  void SetUp() override {
    std::filesystem::copy(finished(), directory_.path(),
                          std::filesystem::copy_options::recursive |
                              std::filesystem::copy_options::overwrite_existing);
  }

  std::filesystem::path out() const { return directory_ / "out"; }

  TemporaryDirectory directory_;
  Program planum_{directory_.path()};
};

TEST_F(Workflow, LeavesTheFilesItPromises) {
  for (const char* name : {"trajectory.tum", "odometry.tum", "graph.g2o", "frames/scan000.frames",
                           "cloud.ply", "mesh.ply", "polygons.json", "map.ply", "map.obj",
                           "map.mtl", "report.json", "topview.png"}) {
    EXPECT_TRUE(std::filesystem::exists(out() / name)) << name;
  }
  const auto report = nlohmann::json::parse(file_text(out() / "report.json"));
  EXPECT_EQ(report["scans"]["count"], 4);
  EXPECT_EQ(report["registration"]["components"], 1);
  EXPECT_LT(report["evaluation"]["ate_rmse_m"], 0.03);
  EXPECT_FALSE(std::filesystem::exists(out() / ".cache/staging"));
}

TEST_F(Workflow, DoesNothingTwice) {
  // A copy has other inodes and times, so that every file is read again: content decides.
  const auto before = result_files(out());
  const Outcome outcome = planum_({"run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* stage :
       {"import", "register", "relax", "cloud", "mesh", "polygons", "labels", "maps", "report"}) {
    EXPECT_SAYS(outcome.err, std::string(stage));
  }
  std::size_t fresh = 0;
  for (std::size_t at = 0; (at = outcome.err.find("fresh", at)) != std::string::npos; ++at) ++fresh;
  EXPECT_EQ(fresh, 9u) << outcome.err;
  EXPECT_TRUE(before == result_files(out()));
}

TEST_F(Workflow, SaysWhatIsStaleAndWhy) {
  Outcome outcome = planum_({"run", "--dry-run", "--set", "mesh.voxel_m=0.1"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_SAYS(outcome.out, "cloud     fresh");
  EXPECT_SAYS(outcome.out, "mesh      stale  parameter mesh.voxel_m changed 0.05 -> 0.1");
  EXPECT_SAYS(outcome.out, "labels    stale  follows polygons");

  std::filesystem::remove(out() / "mesh.ply");
  EXPECT_SAYS(planum_({"status"}).out, "mesh      stale  its output mesh.ply is gone");

  std::ofstream(directory_ / "scans/scan003.slices", std::ios::app) << "# a comment\n";
  outcome = planum_({"status"});
  EXPECT_SAYS(outcome.out, "import    stale  scans/scan003.slices changed");
  EXPECT_SAYS(outcome.out, "register  stale  follows import");
  const auto json = nlohmann::json::parse(planum_({"status", "--json"}).out);
  EXPECT_EQ(json[0]["stage"], "import");
  EXPECT_EQ(json[0]["fresh"], false);

  const TemporaryDirectory empty;
  write_small_project(empty.path());
  EXPECT_SAYS(Program(empty.path())({"status"}).out, "import    stale  never run");
  EXPECT_FALSE(std::filesystem::exists(empty / "out")) << "status must write nothing";
}

TEST_F(Workflow, StopsWhereAResultIsTheSameAsBefore) {
  // A comment in a scan changes the file, but no point: nothing behind import is redone.
  std::ofstream(directory_ / "scans/scan003.slices", std::ios::app) << "# a comment\n";
  const Outcome outcome = planum_({"run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_SAYS(outcome.err, "scans/scan003.slices changed");
  std::size_t fresh = 0;
  for (std::size_t at = 0; (at = outcome.err.find("fresh", at)) != std::string::npos; ++at) ++fresh;
  EXPECT_EQ(fresh, 8u) << outcome.err;
}

TEST_F(Workflow, RedoesOnlyWhatIsAskedFor) {
  const auto before = result_files(out());
  Outcome outcome = planum_({"run", "--from", "mesh", "--until", "polygons", "--force"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("fresh"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("labels"), std::string::npos) << outcome.err;
  EXPECT_TRUE(before == result_files(out())) << "from disk and from memory must be the same";

  outcome = planum_({"run", "--from", "mehs"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "unknown stage 'mehs', did you mean 'mesh'?");
  outcome = planum_({"run", "--from", "mesh", "--until", "cloud"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "--from mesh comes after --until cloud");
}

TEST_F(Workflow, GivesTheSameBytesFromDiskAndOnOneThread) {
  const auto expected = result_files(out());
  std::filesystem::remove_all(out());
  for (const char* stage :
       {"import", "register", "relax", "cloud", "mesh", "polygons", "labels", "maps", "report"}) {
    const Outcome outcome = planum_({"run", "--until", stage, "--threads", "1", "--quiet"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
  }
  expect_same_results(expected, result_files(out()));
}

TEST_F(Workflow, GivesTheMapsThatPolygonizeGivesOfItsCloud) {
  const Outcome outcome =
      planum_({"polygonize", "out/cloud.ply", "--origins", "out/trajectory.tum", "--out", "again"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  int compared = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_ / "again")) {
    if (!entry.is_regular_file()) continue;
    const auto name = std::filesystem::relative(entry.path(), directory_ / "again");
    ++compared;
    EXPECT_TRUE(file_text(out() / name) == file_text(entry.path())) << name << " differs";
  }
  EXPECT_GT(compared, 15);
}

TEST_F(Workflow, CanBeKilledAtAnyMomentAndFinished) {
  const auto expected = result_files(out());
  std::mt19937 random(7);
  for (int round = 0; round < 3; ++round) {
    std::filesystem::remove_all(out());
    for (int i = 0; i < 8; ++i) {
      const std::chrono::milliseconds moment(10 + random() % 700);
      const Outcome killed = planum_({"run"}, {.signal_after = std::chrono::microseconds(moment)});
      ASSERT_TRUE(killed.exit_code == 128 + SIGKILL || killed.exit_code == 0) << killed.err;
    }
    const Outcome finished = planum_({"run"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    expect_same_results(expected, result_files(out()));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out())) {
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
  }
}

TEST_F(Workflow, SaysThatItCanBeContinuedWhenInterrupted) {
  std::filesystem::remove_all(out());
  const Outcome outcome =
      planum_({"run"}, {.signal_after = std::chrono::milliseconds(150), .signal = SIGINT});
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_SAYS(outcome.err, "the same command goes on from there");
}

TEST_F(Workflow, LetsOnlyOneRunIntoADirectory) {
  std::filesystem::remove_all(out());
  Outcome first;
  std::thread runner([&] { first = planum_({"run"}); });
  Outcome second{0, "", ""};
  for (int i = 0; i < 200 && second.exit_code == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (std::filesystem::exists(out() / ".cache/lock"))
      second = planum_({"run", "--until", "import"});
  }
  runner.join();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(second.exit_code, 5);
  EXPECT_SAYS(second.err, "another run (process ");
  EXPECT_SAYS(second.err, "is working in " + out().string() + "; wait until it has ended");
}

TEST_F(Workflow, KeepsEverythingWhenTheDiskIsFull) {
  const auto before = result_files(out());
  const Outcome outcome =
      planum_({"run", "--from", "cloud", "--force"}, {.max_file_bytes = 200'000});
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_SAYS(outcome.err, "cloud: ");
  EXPECT_SAYS(outcome.err, "cloud.ply");
  EXPECT_TRUE(before == result_files(out()));
  EXPECT_EQ(planum_({"run"}).exit_code, 0);
  EXPECT_TRUE(before == result_files(out()));
}

TEST_F(Workflow, NamesAnOutputDirectoryThatCannotBeMade) {
  std::ofstream(directory_ / "in-the-way") << "a file";
  const Outcome outcome = planum_({"run", "--set", "output.directory=in-the-way/out"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_SAYS(outcome.err, "in-the-way/out");
}

TEST_F(Workflow, RefusesToStartBehindWhatIsMissing) {
  std::filesystem::remove_all(out());
  Outcome outcome = planum_({"run", "--from", "mesh"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "import: has never run, so the run cannot start at mesh");
}

TEST_F(Workflow, NamesScansThatConnectToNothing) {
  // A scan of another place: another room, seen from within.
  BuildingPlan plan;
  RoomPlan room;
  room.name = "elsewhere";
  room.walls.outer = {{0, 0}, {9, 0}, {7, 6}, {1, 7}};
  room.height = 3.5;
  plan.rooms = {room};
  const Pose pose = pose_from_xyz_ypr({4, 3, 0.6}, 0.3, 0, 0);
  const RayCaster caster(built(plan).mesh.mesh);
  write_slices(directory_ / "scans/scan003.slices",
               simulate_scan(caster, pose, 9, {.beams = 181, .slices = 70}).scan);
  const Outcome outcome =
      planum_({"run", "--set", "registration.min_overlap=0.9", "--set", "mesh.voxel_m=0.1"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_SAYS(outcome.err, "scan003");
  EXPECT_SAYS(outcome.err, "could not be connected to the other scans");
  EXPECT_EQ(planum_({"run", "--set", "registration.min_overlap=0.9", "--set", "mesh.voxel_m=0.1"})
                .exit_code,
            4)
      << "a fresh result is not better than it was";
}

}  // namespace
}  // namespace planum::testing
