#include "tools/maps/floor_plan.hpp"

#include <cmath>
#include <regex>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using testing::TemporaryDirectory;

/// Two rooms beside each other, 4 x 3 m and 2 x 3 m, with a door and a window, turned and moved.
RoomMap two_rooms(double yaw, const Vector3d& shift) {
  const Pose place = pose_from_xyz_ypr(shift, radians(yaw), 0, 0);
  const auto room = [&](const char* name, double x, double size) {
    Room result;
    result.name = name;
    result.centre = place * Vector3d(x + size / 2, 1.5, 1.25);
    result.along = place.linear() * (size > 3 ? Vector3d::UnitX() : Vector3d::UnitY());
    result.area = 3 * size;
    result.width = std::min(size, 3.0);
    result.depth = std::max(size, 3.0);
    result.height = 2.5;
    for (const Vector3d& p : {Vector3d(x, 0, 0), {x + size, 0, 0}, {x + size, 3, 0}, {x, 3, 0}})
      result.outline.push_back(place * p);
    return result;
  };
  RoomMap rooms;
  rooms.rooms = {room("kitchen & <more>", 0, 4), room("room 2", 4.2, 2)};
  Opening door, window;
  door.position = place * Vector3d(4.1, 1.5, 1);
  door.across = place.linear() * Vector3d::UnitX();
  door.width = 0.9;
  door.thickness = 0.2;
  window = door;
  window.kind = OpeningKind::window;
  window.position = place * Vector3d(-0.1, 1.5, 1.5);
  rooms.openings = {door, window};
  return rooms;
}

std::string drawn(const RoomMap& rooms) {
  const TemporaryDirectory directory;
  write_floor_plan_svg(directory / "plan.svg", rooms);
  return testing::text_of(directory / "plan.svg");
}

std::size_t count(const std::string& text, const std::string& piece) {
  std::size_t result = 0;
  for (std::size_t at = text.find(piece); at != std::string::npos; at = text.find(piece, at + 1))
    ++result;
  return result;
}

/// Lengths of the lines of one class, in units of the drawing.
std::vector<double> lengths(const std::string& text, const std::string& css) {
  const std::regex line("<line class=\"" + css +
                        "\" x1=\"(\\S+)\" y1=\"(\\S+)\" x2=\"(\\S+)\" y2=\"(\\S+)\"/>");
  std::vector<double> result;
  for (std::sregex_iterator i(text.begin(), text.end(), line), end; i != end; ++i)
    result.push_back(std::hypot(std::stod((*i)[3]) - std::stod((*i)[1]),
                                std::stod((*i)[4]) - std::stod((*i)[2])));
  return result;
}

TEST(FloorPlan, HasRoomsOpeningsAndTheirSizes) {
  const std::string text = drawn(two_rooms(0, Vector3d::Zero()));
  EXPECT_EQ(count(text, "<polygon class=\"room\""), 2u);
  EXPECT_EQ(count(text, "class=\"leaf\""), 1u);
  EXPECT_EQ(count(text, "class=\"swing\""), 1u);
  EXPECT_EQ(count(text, "<polygon class=\"window\""), 1u);
  EXPECT_NE(text.find(">kitchen &amp; &lt;more&gt;<"), std::string::npos);
  EXPECT_NE(text.find(">12.0 m², 2.50 m high<"), std::string::npos);
  for (const char* measure : {">4.00<", ">3.00<", ">2.00<", ">0.90<"})
    EXPECT_NE(text.find(measure), std::string::npos) << measure;
  EXPECT_EQ(count(text, "<svg"), count(text, "</svg>"));
  EXPECT_EQ(count(text, "<text"), count(text, "</text>"));
}

TEST(FloorPlan, IsToScaleAndLiesLevelHoweverTheWorldIsTurned) {
  const std::string straight = drawn(two_rooms(0, Vector3d::Zero()));
  for (const double yaw : {33.0, -120.0}) {
    const std::string text = drawn(two_rooms(yaw, {50, -20, 3}));
    std::vector<double> measures;
    for (const double length : lengths(text, "dimension"))
      if (length > 50) measures.push_back(std::round(length));
    std::sort(measures.begin(), measures.end());
    EXPECT_EQ(measures, (std::vector<double>{200, 300, 300, 400}));
    ASSERT_EQ(lengths(text, "leaf").size(), 1u);
    EXPECT_NEAR(lengths(text, "leaf")[0], 90, 0.3);
    const auto head = [](const std::string& svg) { return svg.substr(0, svg.find("<style>")); };
    EXPECT_EQ(head(text), head(straight));  // the same size on paper
  }
}

TEST(FloorPlan, RefusesAMapWithoutRooms) {
  const TemporaryDirectory directory;
  EXPECT_THROW(write_floor_plan_svg(directory / "plan.svg", {}), Error);
  EXPECT_FALSE(std::filesystem::exists(directory / "plan.svg"));
}

}  // namespace
}  // namespace planum
