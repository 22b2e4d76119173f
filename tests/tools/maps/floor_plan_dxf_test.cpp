#include "tools/maps/floor_plan_dxf.hpp"

#include <cmath>
#include <dl_creationadapter.h>
#include <dl_dxf.h>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "slam/core/pose.hpp"
#include "tests/slam/io/io_test_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/tools/maps/two_rooms.hpp"

namespace planum {
namespace {

using Eigen::Vector2d;
using testing::TemporaryDirectory;
using testing::two_rooms;

/// What dxflib finds in a file.
class DxfContent : public DL_CreationAdapter {
 public:
  struct Outline {
    std::string layer;
    bool is_closed;
    std::vector<Vector2d> corners;
  };
  struct Words {
    std::string layer, text;
    Vector2d place;
    double height, turn;
  };

  explicit DxfContent(const std::filesystem::path& path) {
    DL_Dxf reader;
    EXPECT_TRUE(reader.in(path.string(), this));
  }

  void addLayer(const DL_LayerData& data) override { layers.insert(data.name); }
  void addPolyline(const DL_PolylineData& data) override {
    outlines.push_back({getAttributes().getLayer(), (data.flags & 1) != 0, {}});
  }
  void addVertex(const DL_VertexData& data) override {
    outlines.back().corners.emplace_back(data.x, data.y);
  }
  void addLine(const DL_LineData& data) override {
    lines[getAttributes().getLayer()].push_back(
        (Vector2d(data.x2, data.y2) - Vector2d(data.x1, data.y1)).norm());
  }
  void addArc(const DL_ArcData& data) override {
    EXPECT_EQ(getAttributes().getLayer(), "DOORS");
    arcs.push_back(data);
  }
  void addText(const DL_TextData& data) override {
    EXPECT_EQ(data.hJustification, 1);
    texts.push_back({getAttributes().getLayer(), data.text, Vector2d(data.apx, data.apy),
                     data.height, data.angle});
  }
  void setVariableInt(const std::string& key, int value, int) override { numbers[key] = value; }
  void setVariableString(const std::string& key, const std::string& value, int) override {
    strings[key] = value;
  }

  std::set<std::string> layers;
  std::vector<Outline> outlines;
  std::map<std::string, std::vector<double>> lines;  ///< lengths by layer
  std::vector<DL_ArcData> arcs;
  std::vector<Words> texts;
  std::map<std::string, int> numbers;
  std::map<std::string, std::string> strings;
};

double area_of(const std::vector<Vector2d>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / 2;
}

TEST(FloorPlanDxf, ComesBackInMetresOnItsLayers) {
  const TemporaryDirectory directory;
  const PlanDrawing drawing = plan_drawing(two_rooms(33, {50, -20, 3}), 0);
  write_floor_plan_dxf(directory / "plan.dxf", drawing);
  const DxfContent content(directory / "plan.dxf");
  EXPECT_EQ(content.strings.at("$ACADVER"), "AC1015");
  EXPECT_EQ(content.numbers.at("$INSUNITS"), 6);  // metres
  EXPECT_EQ(content.layers,
            (std::set<std::string>{"0", "ROOMS", "DOORS", "WINDOWS", "DIMENSIONS", "TEXT"}));
  std::multiset<std::string> outlines;
  std::vector<double> rooms;
  for (const DxfContent::Outline& outline : content.outlines) {
    EXPECT_TRUE(outline.is_closed);
    outlines.insert(outline.layer);
    if (outline.layer == "ROOMS") rooms.push_back(area_of(outline.corners));
  }
  EXPECT_EQ(outlines, (std::multiset<std::string>{"ROOMS", "ROOMS", "DOORS", "WINDOWS"}));
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NEAR(rooms[0], 12, 1e-4);
  EXPECT_NEAR(rooms[1], 6, 1e-4);
  ASSERT_EQ(content.lines.at("DOORS").size(), 1u);
  EXPECT_NEAR(content.lines.at("DOORS")[0], 0.9, 1e-5);
  EXPECT_EQ(content.lines.at("DIMENSIONS").size(), 4u * 3);
}

TEST(FloorPlanDxf, HasTheArcsAndWordsOfTheDrawing) {
  const TemporaryDirectory directory;
  const PlanDrawing drawing = plan_drawing(two_rooms(-120, {1, 2, 0}), 0);
  write_floor_plan_dxf(directory / "plan.dxf", drawing);
  const DxfContent content(directory / "plan.dxf");
  ASSERT_EQ(content.arcs.size(), 1u);
  const DL_ArcData& arc = content.arcs[0];
  const PlanQuarter& swing = drawing.quarters[0];
  EXPECT_NEAR(arc.radius, 0.9, 1e-5);
  const auto place = [&](double angle) -> Vector2d {
    return {arc.cx + arc.radius * std::cos(radians(angle)),
            arc.cy + arc.radius * std::sin(radians(angle))};
  };
  EXPECT_NEAR((place(arc.angle1) - swing.from).norm(), 0, 1e-4);
  EXPECT_NEAR((place(arc.angle2) - swing.to).norm(), 0, 1e-4);

  ASSERT_EQ(content.texts.size(), drawing.texts.size());
  std::set<std::string> words;
  for (std::size_t i = 0; i < drawing.texts.size(); ++i) {
    const DxfContent::Words& text = content.texts[i];
    words.insert(text.layer + ": " + text.text);
    EXPECT_NEAR((text.place - drawing.texts[i].place).norm(), 0, 1e-5);
    EXPECT_NEAR(text.turn, drawing.texts[i].turn, 1e-6);  // dxflib makes radians of it
    EXPECT_GT(text.height, 0.08);
  }
  EXPECT_TRUE(words.contains("TEXT: kitchen & <more>"));
  EXPECT_TRUE(words.contains("TEXT: 12.0 m\\U+00B2, 2.50 m high"));
  EXPECT_TRUE(words.contains("DIMENSIONS: 4.00"));
  EXPECT_TRUE(words.contains("DIMENSIONS: 0.90"));
}

TEST(FloorPlanDxf, IsAsciiInPairsOfLinesWithHandlesOnce) {
  const TemporaryDirectory directory;
  RoomMap rooms = two_rooms(0, {0, 0, 0});
  rooms.rooms[0].name = "K\u00fcche\nund \u6771";
  write_floor_plan_dxf(directory / "plan.dxf", plan_drawing(rooms, 0));
  std::istringstream lines(testing::text_of(directory / "plan.dxf"));
  std::set<std::string> handles;
  std::string code, value, last, seed;
  bool in_header = false, is_there = false;
  while (std::getline(lines, code)) {
    ASSERT_TRUE(std::getline(lines, value)) << "a code without a value";
    for (const char c : code + value) EXPECT_TRUE(c >= 0x20 && c < 0x7F);
    const int number = std::stoi(code);
    if (number == 2 && last == "SECTION") in_header = value == "HEADER";
    if (!in_header && (number == 5 || number == 105)) {
      EXPECT_TRUE(handles.insert(value).second) << value;
    }
    if (in_header && number == 5) seed = value;
    if (number == 1 && value == "K\\U+00FCche?und \\U+6771") is_there = true;
    last = value;
  }
  EXPECT_EQ(last, "EOF");
  EXPECT_TRUE(is_there);
  EXPECT_GT(handles.size(), 30u);
  for (const std::string& handle : handles)
    EXPECT_LT(std::stoul(handle, nullptr, 16), std::stoul(seed, nullptr, 16));
}

TEST(FloorPlanDxf, SaysWhereItCannotBeWritten) {
  const TemporaryDirectory directory;
  const auto path = directory.path() / "absent" / "plan.dxf";
  testing::expect_cannot_write(path, [&] {
    write_floor_plan_dxf(path, plan_drawing(two_rooms(0, {0, 0, 0}), 0));
  });
}

}  // namespace
}  // namespace planum
