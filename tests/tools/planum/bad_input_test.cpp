#include <map>

#include <gtest/gtest.h>

#include "tests/tools/planum/small_project.hpp"

namespace planum::testing {
namespace {

/// A small project with results; each test spoils its input and expects a message, an exit code,
/// and the earlier results as they were.
class BadInput : public ::testing::Test {
 protected:
  static const std::filesystem::path& finished() {
    static const TemporaryDirectory directory;
    static const bool made = [] {
      write_small_project(directory.path());
      return Program(directory.path())({"run", "--set", "mesh.voxel_m=0.1"}).exit_code == 0;
    }();
    EXPECT_TRUE(made);
    return directory.path();
  }

  void SetUp() override {
    std::filesystem::copy(finished(), directory_.path(),
                          std::filesystem::copy_options::recursive |
                              std::filesystem::copy_options::overwrite_existing);
    before_ = result_files(directory_ / "out");
  }

  void expect_failure(const std::string& message, int exit_code = 3,
                      std::vector<std::string> arguments = {"run"}) {
    const Outcome outcome = planum_(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_SAYS(outcome.err, message);
    EXPECT_TRUE(before_ == result_files(directory_ / "out")) << "earlier results must stay";
  }

  std::filesystem::path scan(int number) const {
    return directory_ / ("scans/scan00" + std::to_string(number) + ".slices");
  }

  TemporaryDirectory directory_;
  Program planum_{directory_.path()};
  std::map<std::string, std::string> before_;
};

TEST_F(BadInput, MissingScanDirectory) {
  std::filesystem::rename(directory_ / "scans", directory_ / "elsewhere");
  expect_failure((directory_ / "scans").string());
  const Outcome outcome = planum_({"init", "nowhere", "-o", "new.toml"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "nowhere");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "new.toml"));
}

TEST_F(BadInput, NoScans) {
  for (int i = 0; i < 4; ++i) std::filesystem::remove(scan(i));
  expect_failure((directory_ / "scans").string());
}

TEST_F(BadInput, AScanWithoutAPose) {
  const std::string text = file_text(directory_ / "odometry.tum");
  std::ofstream(directory_ / "odometry.tum") << text.substr(0, text.find("\n3 ") + 1);
  expect_failure("odometry.tum: there is no pose for number 3");
}

TEST_F(BadInput, ATruncatedLine) {
  const std::string text = file_text(scan(2));
  std::ofstream(scan(2)) << text.substr(0, text.size() - 300);
  expect_failure("scan002.slices:");
  const Outcome outcome = planum_({"check"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.out, "scan002.slices:");
  EXPECT_SAYS(outcome.err, "1 of 4 scans cannot be used");
}

TEST_F(BadInput, AWordAmongNumbers) {
  std::ofstream(scan(2), std::ios::app) << "0.1 5.0 one two three\n";
  expect_failure("scan002.slices:");
}

TEST_F(BadInput, ScansThatAreHalfNotFinite) {
  RawScan raw = read_slices(scan(1));
  std::size_t count = 0;
  for (Slice& slice : raw.slices) {
    for (float& range : slice.ranges) {
      if (++count % 3 != 0) range = count % 2 ? NAN : INFINITY;
    }
  }
  write_slices(scan(1), raw);
  expect_failure("scan001.slices");
}

TEST_F(BadInput, AFewRangesThatAreNotFiniteAreCounted) {
  RawScan raw = read_slices(scan(1));
  raw.slices[3].ranges[7] = NAN;
  raw.slices[3].ranges[8] = INFINITY;
  write_slices(scan(1), raw);
  const Outcome outcome = planum_({"run", "--until", "import"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_SAYS(outcome.err, "2 not finite");
}

TEST_F(BadInput, AnEmptyScan) {
  std::ofstream(scan(1), std::ios::trunc);
  expect_failure("scan001.slices");
}

TEST_F(BadInput, ANumberThatIsThereTwice) {
  std::filesystem::copy(scan(1), directory_ / "scans/scan1.slices");
  expect_failure("scan1.slices");
}

TEST_F(BadInput, TwoFormatsSideBySide) {
  std::ofstream(directory_ / "scans/scan000.3d") << "1 2 3\n";
  expect_failure("--format", 3, {"init", "scans", "-o", "new.toml"});
  std::filesystem::remove(directory_ / "scans/scan000.3d");
}

TEST_F(BadInput, AnUnknownKey) {
  std::ofstream(directory_ / "project.toml", std::ios::app) << "[mesh]\n  voxel_cm = 5\n";
  expect_failure(
      "project.toml:8:3: unknown key 'voxel_cm' in [mesh]; did you mean 'voxel_m'? It takes "
      "metres.");
}

TEST_F(BadInput, NoneOfTheScansHasAPoseAndNothingIsMatched) {
  expect_failure("method = \"none\" trusts the poses that came with the scans", 3,
                 {"run", "--set", "scans.poses=none", "--set", "registration.method=none"});
}

TEST_F(BadInput, ATruthThatIsNotThere) {
  std::filesystem::remove(directory_ / "truth.tum");
  expect_failure("report: " + (directory_ / "truth.tum").string() + ": no such file");
}

}  // namespace
}  // namespace planum::testing
