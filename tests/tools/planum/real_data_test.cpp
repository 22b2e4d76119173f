#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "tests/support/surface_distance.hpp"
#include "tests/tools/planum/program.hpp"

namespace planum::testing {
namespace {

nlohmann::json report_of(const std::filesystem::path& output) {
  return nlohmann::json::parse(file_text(output / "report.json"));
}

/// Runs a data set of ours in a directory of its own; `format` as for init.
std::filesystem::path mapped(const std::filesystem::path& data, const std::string& format,
                             const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  const Program planum(directory);
  Outcome outcome = planum({"init", data.string(), "--format", format});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  outcome = planum({"run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return directory / "out";
}

/// Of places on a surface, how far they are from another one.
struct Distances {
  double median = 0, within_1_mm = 0;
};

Distances distances(const char* what, const TriangleMesh& from, const TriangleMesh& to) {
  const std::vector<double> all = surface_distances(from, to, 300);
  const auto near = std::lower_bound(all.begin(), all.end(), 0.001) - all.begin();
  const Distances result{all[all.size() / 2],
                         static_cast<double>(near) / static_cast<double>(all.size())};
  std::printf("%s: median %.2f mm, %.0f %% within 1 mm\n", what, 1000 * result.median,
              100 * result.within_1_mm);
  return result;
}

// The two forms of the scans differ by up to 0.055 mm (rounding), their points scatter by 24 mm
// about their planes. docs/benchmarks.md says how far that goes.
TEST(RealData, GivesTheSameMapFromPointsAndFromRawSlices) {
  PLANUM_SHARED_DATASET(data, "kurt3d_corridor");
  const TemporaryDirectory directory;
  const auto points = mapped(data, "uos", directory / "uos");
  const auto slices = mapped(data, "slices", directory / "slices");
  const Trajectory a = read_tum(points / "trajectory.tum"), b = read_tum(slices / "trajectory.tum");
  ASSERT_EQ(a.size(), 3u);
  ASSERT_EQ(b.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double shift = (a[i].pose.translation() - b[i].pose.translation()).norm();
    const double turn = rotation_angle(a[i].pose, b[i].pose);
    std::printf("scan %zu: %.2f mm, %.4f deg\n", i, 1000 * shift, degrees(turn));
    EXPECT_LT(shift, 0.001) << i;
    EXPECT_LT(turn, radians(0.03)) << i;
  }
  for (const char* file : {"mesh.ply", "map.ply"}) {
    const TriangleMesh one = read_ply_mesh(points / file), other = read_ply_mesh(slices / file);
    EXPECT_LT(distances(file, one, other).median, 0.001) << file;
    EXPECT_LT(distances(file, other, one).median, 0.001) << file;
  }
}

TEST(RealData, FindsTheClassroomOfThePaper) {
  PLANUM_SHARED_DATASET(data, "classroom");
  const TemporaryDirectory directory;
  const auto report = report_of(mapped(data, "slices", directory / "classroom"));
  const auto truth = nlohmann::json::parse(file_text(data / "dimensions.json"));
  EXPECT_LT(report["evaluation"]["ate_rmse_m"], 0.002);
  EXPECT_LT(report["evaluation"]["rot_mean_deg"], 0.05);
  const auto& expected = truth["rooms"][0];
  double best = 1e9;
  nlohmann::json room;
  for (const auto& candidate : report["rooms"]) {
    const double difference =
        std::abs(candidate["area_m2"].get<double>() -
                 expected["width"].get<double>() * expected["depth"].get<double>());
    if (difference < best) {
      best = difference;
      room = candidate;
    }
  }
  ASSERT_FALSE(room.is_null()) << report["rooms"];
  std::printf("room %.3f x %.3f x %.3f m\n", room["width_m"].get<double>(),
              room["depth_m"].get<double>(), room["height_m"].get<double>());
  EXPECT_NEAR(room["width_m"], expected["width"], 0.04);
  EXPECT_NEAR(room["depth_m"], expected["depth"], 0.04);
  EXPECT_NEAR(room["height_m"], expected["height"], 0.04);
}

TEST(RealData, FindsTheWayThroughTheClassroomWithoutAnyPoses) {
  PLANUM_SHARED_DATASET(data, "classroom");
  const TemporaryDirectory directory;
  const Program planum(directory.path());
  ASSERT_EQ(planum({"init", data.string(), "--format", "slices"}).exit_code, 0);
  const std::string no_poses = "scans.poses=\"none\"";
  const Outcome run = planum({"run", "--until", "cloud", "--set", no_poses});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Outcome evaluated =
      planum({"evaluate", "--set", no_poses, "--truth", (data / "truth.tum").string(), "--json"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  const auto figures = nlohmann::json::parse(evaluated.out);
  EXPECT_EQ(figures["map"]["poses"], 12);
  EXPECT_LT(figures["map"]["ape_translation_m"]["rmse"], 0.01);
  EXPECT_LT(figures["map"]["ape_rotation_deg"]["max"], 0.1);
}

}  // namespace
}  // namespace planum::testing
