#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/kd_tree.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
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

/// m, how far the vertices of one mesh are from their nearest in the other, on average.
double mean_distance(const TriangleMesh& from, const TriangleMesh& to) {
  const KdTree tree(to.vertices);
  double sum = 0;
  for (const Eigen::Vector3f& vertex : from.vertices) {
    const auto near = tree.nearest(vertex, 10);
    sum += near ? std::sqrt(double{near->squared_distance}) : 10.0;
  }
  return sum / static_cast<double>(from.vertices.size());
}

// The aim is 1 mm everywhere. Registration still amplifies the 0.05 mm between the two forms of the
// scans to several millimetres along the corridor, its weak direction (docs/benchmarks.md).
TEST(RealData, GivesTheSameMapFromPointsAndFromRawSlices) {
  PLANUM_SHARED_DATASET(data, "kurt3d_corridor");
  const TemporaryDirectory directory;
  const auto points = mapped(data, "uos", directory / "uos");
  const auto slices = mapped(data, "slices", directory / "slices");
  const Trajectory a = read_tum(points / "trajectory.tum"), b = read_tum(slices / "trajectory.tum");
  ASSERT_EQ(a.size(), 3u);
  ASSERT_EQ(b.size(), 3u);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a[i].pose.translation() - b[i].pose.translation()).norm(), 0.02) << i;
    EXPECT_LT(rotation_angle(a[i].pose, b[i].pose), radians(0.2)) << i;
  }
  const TriangleMesh map_a = read_ply_mesh(points / "map.ply"),
                     map_b = read_ply_mesh(slices / "map.ply");
  const double forth = mean_distance(map_a, map_b), back = mean_distance(map_b, map_a);
  std::printf("maps differ by %.3f and %.3f mm on average\n", 1000 * forth, 1000 * back);
  EXPECT_LT(forth, 0.03);
  EXPECT_LT(back, 0.03);
}

TEST(RealData, FindsTheClassroomOfThePaper) {
  PLANUM_SHARED_DATASET(data, "classroom");
  const TemporaryDirectory directory;
  const auto report = report_of(mapped(data, "slices", directory / "classroom"));
  const auto truth = nlohmann::json::parse(file_text(data / "dimensions.json"));
  EXPECT_LT(report["evaluation"]["ate_rmse_m"], 0.02);
  EXPECT_LT(report["evaluation"]["rot_mean_deg"], 0.3);
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

}  // namespace
}  // namespace planum::testing
