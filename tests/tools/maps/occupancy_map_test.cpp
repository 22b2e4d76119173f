#include "tools/maps/occupancy_map.hpp"

#include <cmath>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using testing::TemporaryDirectory;
using testing::text_of;

/// As map_io of nav2 reads a trinary map: rows from the top, grey to occupancy by the thresholds.
struct RobotsMap {
  double resolution = 0, x = 0, y = 0, yaw = 0;
  int width = 0, height = 0;
  std::vector<int> cells;  ///< -1 unknown, 0 free, 100 occupied; the first row is the lowest
};

RobotsMap loaded(const std::filesystem::path& yaml) {
  std::map<std::string, std::string> keys;
  std::istringstream lines(text_of(yaml));
  for (std::string line; std::getline(lines, line);) {
    const auto colon = line.find(": ");
    EXPECT_NE(colon, std::string::npos) << line;
    EXPECT_TRUE(keys.emplace(line.substr(0, colon), line.substr(colon + 2)).second);
  }
  EXPECT_EQ(keys.at("mode"), "trinary");
  EXPECT_EQ(keys.at("negate"), "0");
  RobotsMap map;
  map.resolution = std::stod(keys.at("resolution"));
  EXPECT_EQ(std::sscanf(keys.at("origin").c_str(), "[%lf, %lf, %lf]", &map.x, &map.y, &map.yaw), 3);
  const double occupied = std::stod(keys.at("occupied_thresh"));
  const double free = std::stod(keys.at("free_thresh"));
  const std::string image = text_of(yaml.parent_path() / keys.at("image"));
  int most = 0, head = 0;
  EXPECT_EQ(std::sscanf(image.c_str(), "P5\n%d %d\n%d%n", &map.width, &map.height, &most, &head),
            3);
  EXPECT_EQ(most, 255);
  const std::size_t begin = static_cast<std::size_t>(head) + 1;
  const auto count = static_cast<std::size_t>(map.width * map.height);
  EXPECT_EQ(image.size(), begin + count);
  map.cells.resize(count);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      const auto at = static_cast<std::size_t>(row * map.width + column);
      const double shade = static_cast<unsigned char>(image[begin + at]) / 255.0, dark = 1 - shade;
      map.cells[static_cast<std::size_t>((map.height - 1 - row) * map.width + column)] =
          dark > occupied ? 100
          : dark < free   ? 0
                          : -1;
    }
  return map;
}

OccupancyGrid some_grid() {
  OccupancyGrid map;
  map.grid.cell = 0.05;
  map.grid.columns = 3;
  map.grid.rows = 2;
  map.grid.plan_from_world = Pose(Eigen::Translation3d(1.25, -2.5, 0));
  map.cells = {Occupancy::unknown, Occupancy::free,     Occupancy::occupied,
               Occupancy::free,    Occupancy::occupied, Occupancy::unknown};
  return map;
}

TEST(OccupancyMap, IsReadByARobotAsItIs) {
  const TemporaryDirectory directory;
  write_occupancy_map(directory / "occupancy.yaml", some_grid());
  const RobotsMap map = loaded(directory / "occupancy.yaml");
  EXPECT_EQ(map.cells, (std::vector<int>{-1, 0, 100, 0, 100, -1}));
  EXPECT_EQ(map.width, 3);
  EXPECT_EQ(map.height, 2);
  EXPECT_EQ(map.resolution, 0.05);
  EXPECT_EQ(map.x, -1.25);
  EXPECT_EQ(map.y, 2.5);
  EXPECT_EQ(map.yaw, 0);
}

TEST(OccupancyMap, RefusesAGridThatIsNone) {
  const TemporaryDirectory directory;
  EXPECT_THROW(write_occupancy_map(directory / "a.yaml", {}), Error);
  OccupancyGrid map = some_grid();
  map.cells.pop_back();
  EXPECT_THROW(write_occupancy_map(directory / "a.yaml", map), Error);
  EXPECT_FALSE(std::filesystem::exists(directory / "a.pgm"));
}

}  // namespace
}  // namespace planum
