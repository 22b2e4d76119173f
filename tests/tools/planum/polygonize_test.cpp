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

}  // namespace
}  // namespace planum::testing
