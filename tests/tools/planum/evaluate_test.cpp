#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/pose_list.hpp"
#include "tests/tools/planum/small_project.hpp"

namespace planum::testing {
namespace {

using Json = nlohmann::json;

/// The small room, run once for all tests.
class Evaluate : public ::testing::Test {
 protected:
  static const std::filesystem::path& finished() {
    static const TemporaryDirectory directory;
    static const bool made = [] {
      write_small_project(directory.path());
      // In so small a room the path says all; loops are looked for all the same.
      std::ofstream(directory / "project.toml", std::ios::app) << "[loops]\nknown_within_m = 0\n";
      write_obj(directory / "building.obj", small_room().mesh);
      write_pose_list(directory / "true_poses.txt", small_room_poses());
      const Outcome outcome = Program(directory.path())({"run", "--threads", "2"});
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      return true;
    }();
    EXPECT_TRUE(made);
    return directory.path();
  }

  Outcome planum(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "evaluate");
    return Program(finished())(arguments);
  }

  Json json(std::vector<std::string> arguments) const {
    arguments.push_back("--json");
    const Outcome outcome = planum(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out);
  }
};

TEST_F(Evaluate, SaysHowGoodAMapIs) {
  const Json figures = json({});
  EXPECT_EQ(figures["map"]["poses"], 4);
  EXPECT_LT(figures["map"]["ape_translation_m"]["rmse"], 0.03);
  EXPECT_LT(figures["map"]["relations"]["translation_m"]["max"], 0.05);
  EXPECT_GT(figures["odometry"]["rpe_per_metre"]["translation_m_per_m"]["mean"], 0);
  EXPECT_GT(figures["points"]["plane_thickness_m"], 0.001);
  EXPECT_LT(figures["points"]["plane_thickness_m"], 0.03);
  ASSERT_FALSE(figures["loops"].empty());
  for (const Json& loop : figures["loops"]) {
    if (!loop["accepted"].get<bool>()) continue;
    EXPECT_LT(loop["after"]["translation_m"], 0.05);
    EXPECT_GE(loop["odometry"]["deviations"], 0);
  }
  if (figures["double_walls"]["after"]["patches"] > 0) {
    EXPECT_LT(figures["double_walls"]["after"]["median_m"], 0.02);
  }
}

TEST_F(Evaluate, PrintsTablesForPeople) {
  const Outcome outcome = planum({});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part : {"odometry: 4 poses", "map: 4 poses", "APE m", "RPE degrees",
                           "plane thickness", "loops: residual", "held out"})
    EXPECT_SAYS(outcome.out, part);
}

TEST_F(Evaluate, NeedsNoTruth) {
  const Json figures = json({"--set", "evaluation.truth=\"\""});
  EXPECT_FALSE(figures.contains("map"));
  EXPECT_TRUE(figures.contains("points"));
  EXPECT_TRUE(figures.contains("loops"));
}

TEST_F(Evaluate, ComparesWithAModelWithAndWithoutPoses) {
  for (const bool with_poses : {true, false}) {
    std::vector<std::string> arguments = {"--model", "building.obj"};
    if (with_poses) arguments.insert(arguments.end(), {"--model-poses", "true_poses.txt"});
    const Json model = json(arguments)["model"];
    EXPECT_EQ(model.contains("fit"), !with_poses);
    EXPECT_LT(model["points_to_model"]["median_m"], 0.03);
    EXPECT_LT(model["map_to_model"]["median_m"], 0.03);
    EXPECT_LT(model["model_to_map"]["median_m"], 0.03);
    EXPECT_GT(model["seen"], 1000);
    EXPECT_LE(model["seen"], model["samples"]);
  }
}

TEST_F(Evaluate, ReadsRelations) {
  const TemporaryDirectory directory;
  const Pose step = small_room_poses()[0].inverse() * small_room_poses()[1];
  const auto p = step.translation();
  std::ofstream(directory / "relations.txt") << "# from to x y z roll pitch yaw\n0 1 " << p.x()
                                             << " " << p.y() << " " << p.z() << " 0 0 0.5\n";
  const Json figures = json({"--relations", (directory / "relations.txt").string()});
  EXPECT_EQ(figures["map"]["relations"]["translation_m"]["count"], 1);
  EXPECT_LT(figures["map"]["relations"]["translation_m"]["max"], 0.03);
  EXPECT_LT(figures["map"]["relations"]["rotation_deg"]["max"], 1);
  const Json edges = json({"--relations", "out/graph.g2o"});
  EXPECT_GE(edges["map"]["relations"]["translation_m"]["count"], 3);
  std::ofstream(directory / "bad.txt") << "0 1 2 3\n";
  const Outcome bad = planum({"--relations", (directory / "bad.txt").string()});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_SAYS(bad.err, "bad.txt:1");
}

TEST_F(Evaluate, TakesBareFiles) {
  const Json figures = json({"out/trajectory.tum", "--truth", "truth.tum"});
  EXPECT_LT(figures["trajectory"]["ape_translation_m"]["rmse"], 0.03);
  EXPECT_FALSE(figures.contains("points"));
  const Outcome alone = planum({"out/trajectory.tum"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_SAYS(alone.err, "--truth FILE or --relations FILE");
  EXPECT_EQ(
      planum({"out/trajectory.tum", "--truth", "truth.tum", "--model", "building.obj"}).exit_code,
      2);
}

TEST_F(Evaluate, AgreesWithTheReport) {
  const Json report = Json::parse(file_text(finished() / "out/report.json"))["evaluation"];
  const Json figures = json({});
  EXPECT_NEAR(report["ate_rmse_m"].get<double>(),
              figures["map"]["ape_translation_m"]["rmse"].get<double>(), 1e-6);
  EXPECT_NEAR(report["plane_thickness_m"].get<double>(),
              figures["points"]["plane_thickness_m"].get<double>(), 0.003);
  ASSERT_EQ(report["loops"].size(), figures["loops"].size());
  for (std::size_t k = 0; k < report["loops"].size(); ++k)
    EXPECT_EQ(report["loops"][k]["after"]["trans_m"],
              figures["loops"][k]["after"]["translation_m"]);
}

TEST_F(Evaluate, SaysWhenThereIsNoMapYet) {
  const TemporaryDirectory directory;
  write_small_project(directory.path());
  const Outcome outcome = Program(directory.path())({"evaluate"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "`planum run project.toml` makes it");
}

}  // namespace
}  // namespace planum::testing
