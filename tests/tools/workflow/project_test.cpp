#include "tools/workflow/project.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "tests/support/shared_data.hpp"
#include "tools/workflow/project_keys.hpp"

namespace planum {
namespace {

class ProjectFile : public ::testing::Test {
 protected:
  Project read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::ofstream(directory_ / "project.toml") << text;
    return read_project(directory_ / "project.toml", overrides);
  }

  /// What reading complains about, without the directory.
  std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
      read(text, overrides);
    } catch (const Error& error) {
      std::string message = error.what();
      const std::string prefix = directory_.path().string() + "/";
      if (message.starts_with(prefix)) message.erase(0, prefix.size());
      return message;
    }
    return "";
  }

  testing::TemporaryDirectory directory_;
};

const std::string scans = "version = 1\n[scans]\ndirectory = \"scans\"\n";

TEST_F(ProjectFile, GivesValuesInTheUnitsOfTheProgram) {
  const Project project =
      read(scans + "max_range_m = 12\n[sensor]\nfirst_beam_deg = -90\n[mesh]\nvoxel_m = 0.1\n");
  EXPECT_EQ(project.settings.limits.max_range, 12);
  EXPECT_DOUBLE_EQ(project.settings.sensor.first_beam.value(), -pi / 2);
  EXPECT_EQ(project.settings.surface.voxel, 0.1);
  EXPECT_EQ(project.origins.at("mesh.voxel_m"), "project.toml:8");
  EXPECT_FALSE(project.origins.contains("scans.min_range_m"));
}

TEST_F(ProjectFile, NamesTheNearestOfAnUnknownKey) {
  EXPECT_EQ(complaint(scans + "\n[mesh]\n  voxel_cm = 5\n"),
            "project.toml:6:3: unknown key 'voxel_cm' in [mesh]; did you mean 'voxel_m'? "
            "It takes metres.");
  EXPECT_EQ(complaint(scans + "max_rnage_m = 5\n"),
            "project.toml:4:1: unknown key 'max_rnage_m' in [scans]; did you mean 'max_range_m'?");
  EXPECT_EQ(complaint(scans + "voxel_m = 5\n"),
            "project.toml:4:1: unknown key 'voxel_m' in [scans]; there is a key of that name in "
            "[mesh]");
  EXPECT_EQ(complaint(scans + "[mehs]\nvoxel_m = 5\n"),
            "project.toml:4:2: unknown table [mehs]; did you mean [mesh]?");
  EXPECT_EQ(complaint("voxel_m = 1\n" + scans),
            "project.toml:1:1: unknown key 'voxel_m' outside of any table; it belongs under "
            "[mesh]");
}

TEST_F(ProjectFile, SaysWhatIsWrongWithAValue) {
  EXPECT_EQ(complaint(scans + "[mesh]\nvoxel_m = \"5cm\"\n"),
            "project.toml:5:11: mesh.voxel_m must be a number, not a text (\"5cm\")");
  EXPECT_EQ(complaint(scans + "[mesh]\nvoxel_m = -1\n")
                .find("project.toml:5:11: mesh.voxel_m = -1 is out of range, allowed: "),
            0u);
  EXPECT_EQ(complaint(scans + "format = \"slice\"\n"),
            "project.toml:4:10: scans.format = \"slice\" is unknown, allowed: \"auto\", \"uos\", "
            "\"slices\", \"ply\" or \"xyz\"; did you mean \"slices\"?");
  EXPECT_EQ(complaint(scans + "min_range_m = nan\n").find("project.toml:4:15: scans.min_range_m"),
            0u);
  EXPECT_EQ(complaint(scans + "format = [1, 2]\n"),
            "project.toml:4:10: scans.format must be a text in quotes");
  EXPECT_EQ(complaint("scans = 3\n"), "project.toml:1:1: 'scans' must be a table: [scans]");
}

TEST_F(ProjectFile, SaysWhereItIsNotToml) {
  const std::string message = complaint(scans + "max_range_m = = 3\n");
  EXPECT_EQ(message.find("project.toml:4:15: "), 0u) << message;
}

TEST_F(ProjectFile, MustNameTheScansAndExist) {
  EXPECT_EQ(complaint("version = 1\n"),
            "project.toml: the key 'directory' in [scans] is missing: where are the scans?");
  try {
    read_project(directory_ / "none.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no such project file"), std::string::npos);
  }
}

TEST_F(ProjectFile, OfANewerVersionIsRefused) {
  EXPECT_EQ(complaint("version = 2\n"),
            "project.toml:1:1: this file has version 2, this program knows versions up to 1; use "
            "a newer planum");
  EXPECT_EQ(complaint("version = \"1\"\n"),
            "project.toml:1:11: version must be a whole number from 1 on");
}

TEST_F(ProjectFile, GivesWayToOverrides) {
  const Project project = read(scans + "[mesh]\nvoxel_m = 0.1\n",
                               {"mesh.voxel_m=0.2", "scans.format=uos", "scans.poses=\"none\""});
  EXPECT_EQ(project.settings.surface.voxel, 0.2);
  EXPECT_EQ(project.settings.scan_format, "uos");
  EXPECT_EQ(project.settings.scan_poses, "none");
  EXPECT_EQ(project.origins.at("mesh.voxel_m"), "--set");
}

TEST_F(ProjectFile, ComplainsAboutBadOverrides) {
  EXPECT_EQ(complaint(scans, {"mesh.voxel_cm=5"}),
            "--set mesh.voxel_cm=5: unknown key 'voxel_cm' in [mesh]; did you mean 'voxel_m'? It "
            "takes metres.");
  EXPECT_EQ(complaint(scans, {"mesh.voxel_m"}),
            "--set mesh.voxel_m: expected key=value, e.g. --set mesh.voxel_m=0.1");
  EXPECT_EQ(complaint(scans, {"voxel_m=1"}),
            "--set voxel_m=1: a key is table.name, e.g. mesh.voxel_m");
  EXPECT_EQ(complaint(scans, {"mehs.voxel_m=1"}),
            "--set mehs.voxel_m=1: unknown table [mehs]; did you mean [mesh]?");
  EXPECT_EQ(complaint(scans, {"mesh.voxel_m=fine"}),
            "--set mesh.voxel_m=fine: mesh.voxel_m must be a number, not a text (\"fine\")");
}

TEST_F(ProjectFile, FromTheTemplateIsReadBackWithAllDefaults) {
  const Settings defaults = read(scans).settings;
  std::string text = project_template({{"scans.directory", "\"scans\""}});
  EXPECT_TRUE(read(text).origins.contains("scans.directory"));
  EXPECT_EQ(read(text).origins.size(), 1u);
  // With every key uncommented the file must mean the same.
  for (std::size_t at = text.find("\n#"); at != std::string::npos; at = text.find("\n#", at + 1)) {
    const bool is_key = text.compare(at + 2, 1, " ") != 0;
    const bool has_value = text.compare(text.find(" =", at), 6, " = ...") != 0;
    if (is_key && has_value) text.erase(at + 1, 1);
  }
  const Project full = read(text);
  for (const Key& key : project_keys()) {
    EXPECT_EQ(value_text(key, full.settings), value_text(key, defaults)) << key.full_name();
  }
}

TEST_F(ProjectFile, PathsStartAtTheFile) {
  const Project project = read(scans + "[output]\ndirectory = \"../results\"\n");
  EXPECT_EQ(output_directory(project), directory_.path().parent_path() / "results");
  EXPECT_EQ(read_project(directory_.path()).file, directory_ / "project.toml");
}

TEST(ProjectKeys, AreWellFormed) {
  std::set<std::string> names;
  const Settings defaults;
  for (const Key& key : project_keys()) {
    EXPECT_TRUE(names.insert(key.full_name()).second) << key.full_name() << " is there twice";
    EXPECT_FALSE(key.help.empty()) << key.full_name();
    EXPECT_NE(find_key(key.full_name()), nullptr);
    EXPECT_TRUE(std::any_of(project_sections().begin(), project_sections().end(),
                            [&](const Section& section) { return section.name == key.section; }));
    EXPECT_LE(key.range.min, key.range.max);
  }
}

TEST(ProjectKeys, AcceptTheirOwnDefaults) {
  const Settings defaults;
  for (const Key& key : project_keys()) {
    const std::string text = value_text(key, defaults);
    if (text.empty() || key.full_name() == "scans.directory") continue;
    Settings settings;
    if (text.starts_with('"')) {
      assign(key, text.substr(1, text.size() - 2), settings);
    } else if (text == "true" || text == "false") {
      assign(key, text == "true", settings);
    } else if (type_name(key) == "a whole number") {
      assign(key, std::int64_t{std::stoll(text)}, settings);
    } else {
      assign(key, std::stod(text), settings);
    }
    EXPECT_EQ(value_text(key, settings), text) << key.full_name();
  }
}

}  // namespace
}  // namespace planum
