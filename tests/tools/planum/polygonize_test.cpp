#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "slam/core/cloud.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/tum.hpp"
#include "tests/tools/planum/program.hpp"

namespace planum::testing {
namespace {

/// An empty room of 4 x 3 x 2.5 m, its west half seen by one scan, its east half by another.
Cloud room_cloud(std::uint32_t west, std::uint32_t east) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> share(0, 1);
  std::normal_distribution<float> noise(0, 0.004f);
  const Eigen::Vector3f size(4, 3, 2.5f);
  Cloud cloud;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {0.0f, 1.0f})
      for (int i = 0; i < 12000; ++i) {
        Eigen::Vector3f p =
            size.cwiseProduct(Eigen::Vector3f(share(random), share(random), share(random)));
        p[axis] = side * size[axis] + noise(random);
        cloud.points.push_back(p);
        cloud.scan.push_back(p.x() < 2 ? west : east);
      }
  return cloud;
}

class Polygonize : public ::testing::Test {
 protected:
  void SetUp() override {
    write_ply(directory_ / "cloud.ply", room_cloud(3, 12));
    const Pose west(Eigen::Translation3d(1, 1.5, 1.2)), east(Eigen::Translation3d(3, 1.5, 1.2));
    // Neither in order nor without gaps.
    write_tum(directory_ / "places.tum", {{12, east}, {3, west}});
    write_tum(directory_ / "one.tum", {{3, west}});
  }

  TemporaryDirectory directory_;
  Program planum_{directory_.path()};
};

TEST_F(Polygonize, MapsARoomWhoseScansGoByTheirNumbers) {
  const Outcome outcome =
      planum_({"polygonize", "cloud.ply", "--origins", "places.tum", "--out", "map"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto map = nlohmann::json::parse(file_text(directory_ / "map" / "polygons.json"));
  double floor = 0, ceiling = 0, wall = 0;
  for (const auto& polygon : map["polygons"]) {
    const double area = polygon["area_m2"];
    const auto normal = polygon["plane"]["normal"].get<std::vector<double>>();
    const double offset = polygon["plane"]["offset"];
    // The middle of the room is in front of every plane.
    EXPECT_GT(normal[0] * 2 + normal[1] * 1.5 + normal[2] * 1.25, offset);
    if (polygon["label"] == "floor") floor += area;
    if (polygon["label"] == "ceiling") ceiling += area;
    if (polygon["label"] == "wall") wall += area;
  }
  EXPECT_NEAR(floor, 12, 0.05);
  EXPECT_NEAR(ceiling, 12, 0.05);
  EXPECT_NEAR(wall, 35, 0.15);
  ASSERT_EQ(map["rooms"].size(), 1u);
  EXPECT_NEAR(map["rooms"][0]["area_m2"].get<double>(), 12, 0.05);
  for (const char* file : {"map.glb", "occupancy.yaml", "map.bt", "floorplan.svg", "cloud.pcd"})
    EXPECT_TRUE(std::filesystem::exists(directory_ / "map" / file)) << file;
}

TEST_F(Polygonize, TakesTheKeysOfAProjectFile) {
  Outcome outcome = planum_({"polygonize", "cloud.ply", "--origins", "places.tum", "--out", "map",
                             "--set", "maps.glb=false", "--set", "maps.occupancy_cell_m=0.5"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(directory_ / "map" / "map.glb"));
  EXPECT_SAYS(file_text(directory_ / "map" / "occupancy.yaml"), "resolution: 0.5");
  outcome = planum_({"polygonize", "cloud.ply", "--out", "map", "--set", "maps.glbb=false"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_SAYS(outcome.err, "unknown key 'glbb' in [maps]; did you mean 'glb'?");
}

TEST_F(Polygonize, OfATiltedRoomHasNoFloorPlan) {
  const Pose tilt(Eigen::AngleAxisd(radians(20), Eigen::Vector3d(1, 2, 0).normalized()));
  write_ply(directory_ / "cloud.ply", transformed(room_cloud(3, 3), tilt));
  write_tum(directory_ / "one.tum", {{3, tilt * Pose(Eigen::Translation3d(1, 1.5, 1.2))}});
  const Outcome outcome =
      planum_({"polygonize", "cloud.ply", "--origins", "one.tum", "--out", "map"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_SAYS(outcome.err, "no rooms: the world is 20 degrees from level");
  EXPECT_SAYS(outcome.err, "no occupancy.yaml: the world is 20 degrees from level");
  EXPECT_SAYS(outcome.err, "no navmesh.bin: the world is 20 degrees from level");
  const auto map = nlohmann::json::parse(file_text(directory_ / "map" / "polygons.json"));
  EXPECT_TRUE(map["rooms"].empty());
  EXPECT_EQ(map["polygons"][0]["label"], "floor");
}

TEST_F(Polygonize, NamesAScanThatHasNoPlace) {
  const Outcome outcome =
      planum_({"polygonize", "cloud.ply", "--origins", "one.tum", "--out", "map"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "cloud.ply: a point is of scan 12, which one.tum does not have");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "map"));
}

TEST_F(Polygonize, WantsToKnowWhichPlaceSawAPoint) {
  Cloud cloud = room_cloud(0, 1);
  cloud.scan.clear();
  write_ply(directory_ / "cloud.ply", cloud);
  Outcome outcome = planum_({"polygonize", "cloud.ply", "--origins", "places.tum", "--out", "map"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_SAYS(outcome.err, "points do not know their scan");
  outcome = planum_({"polygonize", "cloud.ply", "--origins", "one.tum", "--out", "map"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST_F(Polygonize, TakesOnePlaceAndSaysWhichItAssumes) {
  Cloud cloud = room_cloud(0, 0);
  cloud.scan.clear();
  for (Eigen::Vector3f& p : cloud.points) p += Eigen::Vector3f(10, 20, 30);
  write_ply(directory_ / "cloud.ply", cloud);
  Outcome outcome = planum_({"polygonize", "cloud.ply", "--out", "map"});
  EXPECT_SAYS(outcome.err, "it is taken to be at 0 0 0");
  EXPECT_SAYS(outcome.err, "there are no rooms, no objects, no occupancy.yaml and no map.bt");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(
      nlohmann::json::parse(file_text(directory_ / "map" / "polygons.json"))["rooms"].empty());
  EXPECT_FALSE(std::filesystem::exists(directory_ / "map" / "occupancy.yaml"));
  outcome = planum_({"polygonize", "cloud.ply", "--origin", "12", "21.5", "31.25", "--out", "map"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto map = nlohmann::json::parse(file_text(directory_ / "map" / "polygons.json"));
  double area = 0;
  for (const auto& polygon : map["polygons"]) {
    area += polygon["area_m2"].get<double>();
    const auto normal = polygon["plane"]["normal"].get<std::vector<double>>();
    EXPECT_GT(normal[0] * 12 + normal[1] * 21.5 + normal[2] * 31.25, polygon["plane"]["offset"]);
  }
  EXPECT_NEAR(area, 59, 0.25);
}

TEST_F(Polygonize, ReadsPointsOfAnyFormatAndLeavesOutWhatIsNotFinite) {
  const Cloud cloud = room_cloud(0, 0);
  std::string text = "nan nan nan\n1e9 1e9 1e9\n";
  for (const Eigen::Vector3f& p : cloud.points)
    text +=
        std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  std::ofstream(directory_ / "cloud.pts") << text;
  const Outcome outcome =
      planum_({"polygonize", "cloud.pts", "--origin", "2", "1.5", "1.2", "--out", "map"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_SAYS(outcome.err, "cloud.pts: 1 of 72002 points are not finite and are left out");
  const auto map = nlohmann::json::parse(file_text(directory_ / "map" / "polygons.json"));
  EXPECT_EQ(map["polygons"].size(), 6u);
}

TEST_F(Polygonize, SaysWhatIsWrongWithACloud) {
  const auto error_of = [&](const std::string& name, const std::string& text) {
    std::ofstream(directory_ / name) << text;
    const Outcome outcome = planum_({"polygonize", name, "--out", "map"});
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_FALSE(std::filesystem::exists(directory_ / "map"));
    return outcome.err;
  };
  EXPECT_SAYS(error_of("a.xyz", ""), "a.xyz: there are no points in it");
  EXPECT_SAYS(error_of("a.xyz", "nan 0 0\n0 inf 0\n"), "a.xyz: not one of its points is finite");
  EXPECT_SAYS(error_of("a.doc", "1 2 3\n"), "a.doc: no file of points by its ending");
  std::string equal, line;
  for (int i = 0; i < 1000; ++i) {
    equal += "1 2 3\n";
    line += std::to_string(0.001 * i) + " 0 0\n";
  }
  EXPECT_SAYS(error_of("a.xyz", equal), "no point has a normal: nowhere do points lie around");
  EXPECT_SAYS(error_of("a.xyz", line), "no point has a normal: nowhere do points lie around");
}

}  // namespace
}  // namespace planum::testing
