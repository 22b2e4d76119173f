#include <algorithm>
#include <cmath>
#include <regex>

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/two_rooms.hpp"
#include "tools/maps/floor_plan_svg.hpp"

namespace planum {
namespace {

using Eigen::Vector3d;
using testing::TemporaryDirectory;
using testing::two_rooms;

std::string drawn(const RoomMap& rooms) {
  const TemporaryDirectory directory;
  write_floor_plan_svg(directory / "plan.svg", plan_drawing(rooms, 0));
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

TEST(FloorPlan, TurnsLeavesInTheirSwingToTheWall) {
  const RoomMap rooms = two_rooms(75, {3, 4, 0});
  const PlanDrawing drawing = plan_drawing(rooms, 0);
  ASSERT_EQ(drawing.quarters.size(), 1u);
  const PlanQuarter& swing = drawing.quarters[0];
  const Eigen::Vector2d open = swing.from - swing.centre, shut = swing.to - swing.centre;
  EXPECT_NEAR(open.norm(), 0.9, 1e-9);
  EXPECT_NEAR((Eigen::Rotation2Dd(pi / 2) * open - shut).norm(), 0, 1e-9);
  const auto leaf = std::find_if(drawing.lines.begin(), drawing.lines.end(),
                                 [](const PlanLine& line) { return line.part == PlanPart::leaf; });
  ASSERT_NE(leaf, drawing.lines.end());
  EXPECT_NEAR((leaf->from - swing.centre).norm() + (leaf->to - swing.from).norm(), 0, 1e-9);
}

TEST(FloorPlan, DrawsEachStoreyOnPaperOfTheSamePlaceAndSize) {
  RoomMap rooms = two_rooms(20, {0, 0, 0});
  rooms.storeys = {0, 3};
  rooms.rooms[1].storey = 1;
  rooms.openings[0].rooms = {1};
  const PlanDrawing ground = plan_drawing(rooms, 0), upper = plan_drawing(rooms, 1);
  EXPECT_EQ(ground.turn, upper.turn);
  EXPECT_TRUE(ground.paper.isApprox(upper.paper));
  const auto count_of = [](const PlanDrawing& drawing, PlanPart part) {
    return std::count_if(drawing.polygons.begin(), drawing.polygons.end(),
                         [&](const PlanPolygon& polygon) { return polygon.part == part; });
  };
  EXPECT_EQ(count_of(ground, PlanPart::room), 1);
  EXPECT_EQ(count_of(upper, PlanPart::room), 1);
  EXPECT_EQ(count_of(ground, PlanPart::window), 1);
  EXPECT_EQ(count_of(ground, PlanPart::doorway), 0);
  EXPECT_EQ(count_of(upper, PlanPart::doorway), 1);
}

TEST(FloorPlan, RefusesAStoreyWithoutRooms) {
  EXPECT_THROW(plan_drawing({}, 0), Error);
  EXPECT_THROW(plan_drawing(two_rooms(0, Vector3d::Zero()), 1), Error);
}

}  // namespace
}  // namespace planum
