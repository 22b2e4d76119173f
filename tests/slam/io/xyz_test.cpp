#include "slam/io/xyz.hpp"

#include <cmath>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::write_text;

Cloud cloud_from(const std::string& text) {
  const TemporaryDirectory directory;
  write_text(directory / "scan000.xyz", text);
  return read_xyz(directory / "scan000.xyz");
}

std::string error_from(const std::string& text) {
  const TemporaryDirectory directory;
  return testing::error_in_text(directory / "scan000.xyz", text, read_xyz);
}

TEST(Xyz, TakesTheFourthOfFourOrSevenColumnsAsIntensity) {
  EXPECT_EQ(cloud_from("1 2 3\n4 5 6").points.back(), Eigen::Vector3f(4, 5, 6));
  EXPECT_TRUE(cloud_from("1 2 3").intensity.empty());
  EXPECT_EQ(cloud_from("1 2 3 0.5 # note").intensity, std::vector<float>{0.5f});
  EXPECT_EQ(cloud_from("1 2 3 0.5 255 0 0").intensity, std::vector<float>{0.5f});
  EXPECT_TRUE(cloud_from("1 2 3 255 0 0").intensity.empty());
}

TEST(Xyz, KeepsPointsThatAreNotFinite) {
  const Cloud cloud = cloud_from("nan nan nan\n1 2 inf\n");
  ASSERT_EQ(cloud.points.size(), 2u);
  EXPECT_TRUE(std::isnan(cloud.points[0].x()));
  EXPECT_EQ(cloud.points[1].z(), HUGE_VALF);
}

TEST(Xyz, SaysWhereALineIsWrong) {
  EXPECT_EQ(error_from("1 2 3\n4 5"), "FILE:2: expected 3 numbers, got 2");
  EXPECT_EQ(error_from("1,5 2,5 3,5\n"), "FILE:1: expected a number, got \"1,5\"");
  EXPECT_EQ(error_from("# x y z\n"), "FILE: there are no points in it");
}

TEST(Xyz, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  testing::Draws draws(6);
  Cloud cloud;
  for (int i = 0; i < 2000; ++i) {
    cloud.points.push_back(draws.vector(std::pow(10, draws.uniform(-4, 4))).cast<float>());
    cloud.intensity.push_back(static_cast<float>(draws.uniform(0, 4096)));
  }
  write_xyz(directory / "a.xyz", cloud);
  Cloud read = read_xyz(directory / "a.xyz");
  EXPECT_EQ(read.points, cloud.points);
  EXPECT_EQ(read.intensity, cloud.intensity);
  cloud.intensity.clear();
  write_xyz(directory / "a.xyz", cloud);
  EXPECT_TRUE(read_xyz(directory / "a.xyz").intensity.empty());
}

TEST(Xyz, ReadsTheEntranceHall) {
  PLANUM_SHARED_DATASET(hall, "entrance_hall");
  const Cloud cloud = read_xyz(hall / "scan.dat");
  ASSERT_EQ(cloud.points.size(), 88206u);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(-0.0434742f, -4.82982f, 0.499645f));
}

}  // namespace
}  // namespace planum
