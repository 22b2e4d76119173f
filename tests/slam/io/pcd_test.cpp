#include "slam/io/pcd.hpp"

#include <cstring>

#include "io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::text_of;

constexpr const char* start = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n";

TEST(Pcd, HasAHeaderAndRowsAsPclReadsThem) {
  const TemporaryDirectory directory;
  Cloud cloud;
  cloud.points = {{1, 2, 3}, {-4, 5.5f, 6}};
  cloud.normals = {{0, 0, 1}, {1, 0, 0}};
  cloud.intensity = {0.25f, 7};
  cloud.scan = {3, 4000000000u};
  write_pcd(directory / "a.pcd", cloud);
  const std::string text = text_of(directory / "a.pcd");
  const std::string header = std::string(start) +
                             "FIELDS x y z normal_x normal_y normal_z intensity scan\n"
                             "SIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F U\nCOUNT 1 1 1 1 1 1 1 1\n"
                             "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";
  ASSERT_EQ(text.substr(0, header.size()), header);
  ASSERT_EQ(text.size(), header.size() + 2 * 32);
  for (std::size_t i = 0; i < 2; ++i) {
    float values[7];
    std::uint32_t scan = 0;
    std::memcpy(values, text.data() + header.size() + 32 * i, 28);
    std::memcpy(&scan, text.data() + header.size() + 32 * i + 28, 4);
    EXPECT_EQ(Eigen::Vector3f(values[0], values[1], values[2]), cloud.points[i]);
    EXPECT_EQ(Eigen::Vector3f(values[3], values[4], values[5]), cloud.normals[i]);
    EXPECT_EQ(values[6], cloud.intensity[i]);
    EXPECT_EQ(scan, cloud.scan[i]);
  }
}

TEST(Pcd, HasOnlyWhatTheCloudHas) {
  const TemporaryDirectory directory;
  Cloud cloud;
  write_pcd(directory / "a.pcd", cloud);
  EXPECT_NE(text_of(directory / "a.pcd").find("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"),
            std::string::npos);
  cloud.points.resize(3);
  cloud.scan.resize(2);
  EXPECT_THROW(write_pcd(directory / "b.pcd", cloud), Error);
  EXPECT_FALSE(std::filesystem::exists(directory / "b.pcd"));
}

}  // namespace
}  // namespace planum
