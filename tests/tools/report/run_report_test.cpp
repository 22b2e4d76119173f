#include "tools/report/run_report.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/small_map.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;
using testing::TemporaryDirectory;

Json written(const RunReport& report) {
  const TemporaryDirectory directory;
  write_report_json(directory / "report.json", report);
  return Json::parse(testing::text_of(directory / "report.json"));
}

RunReport full_report(const testing::SmallMap& small) {
  RunReport report;
  report.version = "1.2.3";
  report.threads = 8;
  report.stages = {{"import", 0.5, true, 120}, {"register", 2.25, false, 340.5}};
  report.scans = {.count = 3, .points = 1000, .no_return = 4, .not_finite = 5, .out_of_range = 6};
  report.registration = {.pairs = 2,
                         .pairs_failed = 1,
                         .rms = 0.015,
                         .loops_accepted = 7,
                         .loops_rejected = 9,
                         .components = {{"scan000", "scan001"}, {"scan002"}}};
  report.evaluation = {.ate_rmse = 0.01,
                       .ate_max = 0.02,
                       .rot_mean = radians(0.25),
                       .rot_max = radians(0.5),
                       .rpe_trans = 0.003,
                       .rpe_rot = radians(0.125),
                       .drift = DriftFigures{.trans = 0.01, .rot = radians(0.5), .segments = 6}};
  report.odometry_evaluation.emplace().ate_rmse = 1.5;
  report.map_evaluation.emplace();
  report.map_evaluation->entropy = -4.5;
  report.map_evaluation->plane_thickness = 0.008;
  report.map_evaluation->walls_before = {.median = 0.03, .percentile_90 = 0.06};
  report.map_evaluation->walls = {.median = 0.001, .percentile_90 = 0.002};
  report.map_evaluation->loops = {{.from = 0,
                                   .to = 5,
                                   .accepted = true,
                                   .reason = "",
                                   .before = {0.1, radians(2), 5},
                                   .after = {0.01, radians(0.25), 0.5},
                                   .held_out = ResidualFigures{0.02, radians(0.5), 1}},
                                  {.from = 1,
                                   .to = 7,
                                   .accepted = false,
                                   .reason = "too few pairs",
                                   .before = {},
                                   .after = {},
                                   .held_out = {}}};
  report.levelled = radians(2);
  report.mesh = {.vertices = 50, .triangles = 96};
  report.polygons = {
      .count = 10, .vertices = 16, .area = 59.7, .rest_triangles = 2, .compression = 0.75};
  report.map = &small.map;
  report.labels = &small.labels;
  report.rooms = &small.rooms;
  return report;
}

TEST(RunReport, HasTheKeysThatStay) {
  testing::SmallMap small = testing::small_map();
  small.rooms.openings.resize(1);
  small.rooms.openings[0].rooms = {0};
  const Json json = written(full_report(small));
  const std::vector<std::pair<std::string, Json>> expected = {
      {"/planum/version", "1.2.3"},
      {"/threads", 8},
      {"/stages/import/seconds", 0.5},
      {"/stages/import/cached", true},
      {"/stages/import/peak_memory_mb", 120.0},
      {"/stages/register/seconds", 2.25},
      {"/stages/register/cached", false},
      {"/stages/register/peak_memory_mb", 340.5},
      {"/scans/count", 3},
      {"/scans/points", 1000},
      {"/registration/pairs", 2},
      {"/registration/rms_m", 0.015},
      {"/registration/loops_accepted", 7},
      {"/registration/loops_rejected", 9},
      {"/registration/components", 2},
      {"/evaluation/ate_rmse_m", 0.01},
      {"/evaluation/ate_max_m", 0.02},
      {"/evaluation/rot_mean_deg", 0.25},
      {"/evaluation/rpe_trans_m", 0.003},
      {"/evaluation/rpe_per_metre/trans_m", 0.01},
      {"/evaluation/rpe_per_metre/rot_deg", 0.5},
      {"/evaluation/rpe_per_metre/segments", 6},
      {"/evaluation/mme", -4.5},
      {"/evaluation/plane_thickness_m", 0.008},
      {"/evaluation/double_wall_gap_before_m", 0.03},
      {"/evaluation/double_wall_gap_before_90_m", 0.06},
      {"/evaluation/double_wall_gap_m", 0.001},
      {"/evaluation/double_wall_gap_90_m", 0.002},
      {"/evaluation/loops/0/from", 0},
      {"/evaluation/loops/0/to", 5},
      {"/evaluation/loops/0/accepted", true},
      {"/evaluation/loops/0/before/trans_m", 0.1},
      {"/evaluation/loops/0/before/rot_deg", 2.0},
      {"/evaluation/loops/0/before/deviations", 5.0},
      {"/evaluation/loops/0/after/trans_m", 0.01},
      {"/evaluation/loops/0/held_out/rot_deg", 0.5},
      {"/evaluation/loops/1/accepted", false},
      {"/evaluation/loops/1/reason", "too few pairs"},
      {"/mesh/vertices", 50},
      {"/mesh/triangles", 96},
      {"/polygons/count", 10},
      {"/polygons/vertices", 16},
      {"/polygons/area_m2", 59.7},
      {"/polygons/rest_triangles", 2},
      {"/polygons/compression", 0.75},
      {"/labels/floor/count", 1},
      {"/labels/ceiling/area_m2", 12.0},
      {"/rooms/0/name", "room 1"},
      {"/rooms/0/centre", Json::array({2.0, 1.5, 1.25})},
      {"/rooms/0/area_m2", 12.0},
      {"/rooms/0/width_m", 3.0},
      {"/rooms/0/depth_m", 4.0},
      {"/rooms/0/height_m", 2.5},
      {"/openings/0/kind", "door"},
      {"/openings/0/width_m", 0.0},
      {"/openings/0/height_m", 0.0},
      {"/openings/0/position", Json::array({0.0, 0.0, 0.0})},
      {"/openings/0/rooms", Json::array({"room 1"})}};
  for (const auto& [key, value] : expected) {
    const Json::json_pointer at(key);
    ASSERT_TRUE(json.contains(at)) << key;
    if (value.is_number_float())
      EXPECT_NEAR(json[at].get<double>(), value.get<double>(), 1e-12) << key;
    else
      EXPECT_EQ(json[at], value) << key;
  }
}

TEST(RunReport, HasWhatElseAReaderAsksFor) {
  const testing::SmallMap small = testing::small_map();
  const Json json = written(full_report(small));
  EXPECT_EQ(json["scans"]["no_return"], 4);
  EXPECT_EQ(json["scans"]["not_finite"], 5);
  EXPECT_EQ(json["scans"]["out_of_range"], 6);
  EXPECT_EQ(json["registration"]["pairs_failed"], 1);
  EXPECT_EQ(json["registration"]["scans_of_components"],
            Json::parse(R"([["scan000", "scan001"], ["scan002"]])"));
  EXPECT_NEAR(json["evaluation"]["rot_max_deg"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(json["evaluation"]["rpe_rot_deg"].get<double>(), 0.125, 1e-12);
  EXPECT_EQ(json["evaluation"]["odometry"]["ate_rmse_m"], 1.5);
  EXPECT_NEAR(json["world"]["levelled_deg"].get<double>(), 2, 1e-12);
}

TEST(RunReport, EvaluatesTheMapWithoutATruthToo) {
  RunReport report;
  report.map_evaluation.emplace().entropy = -3;
  const Json evaluation = written(report)["evaluation"];
  EXPECT_EQ(evaluation["mme"], -3.0);
  EXPECT_TRUE(evaluation["loops"].empty());
  EXPECT_FALSE(evaluation.contains("ate_rmse_m"));
  EXPECT_FALSE(evaluation.contains("double_wall_gap_m"));
  EXPECT_FALSE(written(full_report({}))["evaluation"]["loops"][1].contains("held_out"));
}

TEST(RunReport, KeepsStagesInTheirOrder) {
  RunReport report;
  report.stages = {{"register", 1, true, 1}, {"import", 1, true, 1}, {"mesh", 1, true, 1}};
  const Json json = written(report);
  std::vector<std::string> names;
  for (const auto& [stage, cost] : json["stages"].items()) names.push_back(stage);
  EXPECT_EQ(names, (std::vector<std::string>{"register", "import", "mesh"}));
}

TEST(RunReport, LeavesOutWhatWasNotMade) {
  RunReport report;
  report.version = "1";
  report.threads = 2;
  EXPECT_EQ(written(report),
            Json::parse(R"({"planum": {"version": "1"}, "threads": 2, "stages": {}})"));
}

TEST(RunReport, CountsEveryPolygonUnderOneLabel) {
  const testing::SmallMap small = testing::small_map(testing::Draws(1).pose());
  const Json labels = written(full_report(small))["labels"];
  EXPECT_EQ(labels.size(), all_labels.size());
  EXPECT_EQ(labels["floor"]["count"], 1);
  EXPECT_EQ(labels["ceiling"]["count"], 1);
  EXPECT_EQ(labels["wall"]["count"], 4);
  EXPECT_EQ(labels["unknown"]["count"], 4);
  EXPECT_NEAR(labels["floor"]["area_m2"].get<double>(), 4 * 3 - 0.8, 1e-9);
  EXPECT_NEAR(labels["wall"]["area_m2"].get<double>(), 2 * (4 + 3) * 2.5, 1e-9);
  EXPECT_NEAR(labels["unknown"]["area_m2"].get<double>(), 2 * (1 + 0.8) * 0.7, 1e-9);
}

TEST(RunReport, HasAZeroForALabelThatIsNowhere) {
  const testing::SmallMap none;
  const Json labels = written(full_report(none))["labels"];
  for (const Label label : all_labels) {
    EXPECT_EQ(labels[name(label)]["count"], 0) << name(label);
    EXPECT_EQ(labels[name(label)]["area_m2"], 0.0) << name(label);
  }
}

TEST(RunReport, IsJsonWhateverTheScansAreCalled) {
  RunReport report;
  report.registration.emplace();
  report.registration->components = {
      {"Pr\xfc"
       "fung1",
       "\"scan\"\n2", "Prüfung3"}};
  const Json names = written(report)["registration"]["scans_of_components"][0];
  ASSERT_EQ(names.size(), 3u);
  EXPECT_EQ(names[0], "Pr\uFFFDfung1");  // Latin-1 in an old file name
  EXPECT_EQ(names[1], "\"scan\"\n2");
  EXPECT_EQ(names[2], "Prüfung3");
}

TEST(RunReport, IsJsonWhenAFigureIsNone) {
  RunReport report;
  report.registration.emplace();
  report.registration->rms = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(written(report)["registration"]["rms_m"].is_null());
}

TEST(RunReport, SaysWhenLabelsAreOfAnotherMap) {
  const TemporaryDirectory directory;
  testing::SmallMap small = testing::small_map();
  small.labels.polygons.pop_back();
  EXPECT_EQ(
      testing::error_of([&] { write_report_json(directory / "report.json", full_report(small)); }),
      "report: labels and polygons do not match");
  EXPECT_TRUE(std::filesystem::is_empty(directory.path()));
}

TEST(RunReport, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "absent" / "report.json";
  testing::expect_cannot_write(path, [&] { write_report_json(path, {}); });
}

}  // namespace
}  // namespace planum
