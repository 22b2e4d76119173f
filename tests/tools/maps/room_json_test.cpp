#include "tools/maps/room_json.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

RoomMap two_rooms() {
  RoomMap map;
  map.rooms.resize(2);
  map.rooms[0] = {.name = "room 1",
                  .centre = {1.50004, 2, 1.25},
                  .along = {0.6, 0.8, 0},
                  .area = 11.99996,
                  .width = 3.00006,
                  .depth = 4,
                  .height = 2.5,
                  .outline = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}, {0, 4, 0}},
                  .scans = {0}};
  map.rooms[1].name = "room 2";
  map.openings.resize(2);
  map.openings[0] = {.kind = OpeningKind::door,
                     .position = {3.1, 2, 1},
                     .across = {1, 0, 0},
                     .width = 0.9,
                     .height = 2,
                     .sill = 0,
                     .thickness = 0.2,
                     .rooms = {1, 0}};
  map.openings[1].kind = OpeningKind::window;
  map.openings[1].rooms = {1};
  return map;
}

TEST(RoomJson, SaysWhatARoomIsToTenthsOfMillimetres) {
  const Json rooms = rooms_json(two_rooms());
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_EQ(rooms[0], Json::parse(R"({"name": "room 1", "storey": 1, "centre": [1.5, 2.0, 1.25],
      "area_m2": 12.0, "perimeter_m": 14.0, "width_m": 3.0001, "depth_m": 4.0, "height_m": 2.5,
      "depth_direction": [0.6, 0.8, 0.0], "neighbours": ["room 2"],
      "outline": [[0.0,0.0,0.0], [3.0,0.0,0.0], [3.0,4.0,0.0], [0.0,4.0,0.0]]})"));
  EXPECT_EQ(rooms[1]["name"], "room 2");
  EXPECT_EQ(rooms[1]["outline"], Json::array());
}

TEST(RoomJson, NamesTheRoomsOfAnOpening) {
  const Json openings = openings_json(two_rooms());
  ASSERT_EQ(openings.size(), 2u);
  EXPECT_EQ(openings[0], Json::parse(R"({"kind": "door", "position": [3.1, 2.0, 1.0],
      "across": [1.0, 0.0, 0.0], "width_m": 0.9, "height_m": 2.0, "sill_m": 0.0,
      "thickness_m": 0.2, "rooms": ["room 2", "room 1"]})"));
  EXPECT_EQ(openings[1]["kind"], "window");
  EXPECT_EQ(openings[1]["rooms"], Json::parse(R"(["room 2"])"));
}

TEST(RoomJson, IsAnEmptyListWhereThereIsNothing) {
  EXPECT_EQ(rooms_json({}), Json::array());
  EXPECT_EQ(openings_json({}), Json::array());
}

}  // namespace
}  // namespace planum
