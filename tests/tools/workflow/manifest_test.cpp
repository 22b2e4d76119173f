#include "tools/workflow/manifest.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

Manifest example() {
  Manifest manifest;
  manifest.version = 3;
  manifest.parameters = {{"mesh.voxel_m", "0.05"}, {"sensor.mount_x_m", ""}};
  manifest.inputs = {{"scans/scan003.3d", Hasher().text("a").result()}};
  manifest.outputs = {{"mesh.ply", Hasher().text("b").result()}};
  manifest.units = {".cache/import/units/scan003.unit"};
  manifest.seconds = 1.5;
  manifest.peak_memory_mb = 100;
  manifest.summary = "1 mesh";
  manifest.warnings = {"thin"};
  manifest.shortcomings = {"scan004 connects to nothing"};
  return manifest;
}

TEST(Manifest, SurvivesTheFile) {
  const testing::TemporaryDirectory directory;
  const Manifest manifest = example();
  write_manifest(directory / "manifest.json", manifest);
  const auto back = read_manifest(directory / "manifest.json");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->version, 3);
  EXPECT_EQ(back->parameters, manifest.parameters);
  EXPECT_EQ(back->inputs, manifest.inputs);
  EXPECT_EQ(back->outputs, manifest.outputs);
  EXPECT_EQ(back->units, manifest.units);
  EXPECT_EQ(back->seconds, 1.5);
  EXPECT_EQ(back->summary, "1 mesh");
  EXPECT_EQ(back->warnings, manifest.warnings);
  EXPECT_EQ(back->shortcomings, manifest.shortcomings);
}

TEST(Manifest, ThatCannotBeUnderstoodIsNone) {
  const testing::TemporaryDirectory directory;
  EXPECT_FALSE(read_manifest(directory / "manifest.json"));
  for (const char* text : {"", "{", "[]", "{\"version\": 1}", "{\"version\": \"x\"}"}) {
    std::ofstream(directory / "manifest.json") << text;
    EXPECT_FALSE(read_manifest(directory / "manifest.json")) << text;
  }
}

TEST(Manifest, SaysWhatDiffers) {
  EXPECT_EQ(first_difference(example(), example()), "");

  Manifest now = example();
  now.parameters["mesh.voxel_m"] = "0.1";
  EXPECT_EQ(first_difference(example(), now), "parameter mesh.voxel_m changed 0.05 -> 0.1");

  now = example();
  now.parameters["sensor.mount_x_m"] = "0.2";
  EXPECT_EQ(first_difference(example(), now), "parameter sensor.mount_x_m changed (unset) -> 0.2");

  now = example();
  now.inputs["scans/scan003.3d"] = Hasher().text("other").result();
  EXPECT_EQ(first_difference(example(), now), "scans/scan003.3d changed");
  now.inputs["scans/scan004.3d"] = Hasher().text("new").result();
  EXPECT_EQ(first_difference(example(), now), "scans/scan003.3d changed (and 1 more)");

  now = example();
  now.inputs.clear();
  EXPECT_EQ(first_difference(example(), now), "scans/scan003.3d is gone");

  now = example();
  now.version = 4;
  EXPECT_EQ(first_difference(example(), now), "planum does this differently now (version 3 -> 4)");

  now = example();
  now.outputs.clear();
  EXPECT_EQ(first_difference(example(), now), "");
}

}  // namespace
}  // namespace planum
