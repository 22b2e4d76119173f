#include "labeling/reflections.hpp"

#include <gtest/gtest.h>

#include "slam/core/error.hpp"
#include "tests/labeling/plans.hpp"

namespace planum {
namespace {

using testing::PlanMaker;
using testing::Vector3d;

constexpr double pane = 5.13;  // m, x of the pane of the window in the wall between 5 and 5.3

/// A room 5 x 4 x 2.6 m with a cupboard and a window to the east.
PlanMaker furnished_room() {
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {5, 4, 2.6});
  plan.add_furniture({1, 3, 0}, {2, 3.5, 1.8});
  return plan;
}

/// Another furnished_room where the window's pane shows it, with the names of its own labels.
void add_mirror_image(PlanMaker& plan, const std::vector<std::string>& labels) {
  const PlanMaker room = furnished_room();
  for (std::size_t i = 0; i < room.map.polygons.size(); ++i) {
    std::vector<Vector3d> ring;
    for (const std::uint32_t v : room.map.polygons[i].outer) {
      const Vector3d p = room.map.vertices[v];
      ring.insert(ring.begin(), {2 * pane - p.x(), p.y(), p.z()});
    }
    plan.add(labels[i], ring);
  }
}

struct Scene {
  PolygonMap map;
  Labels labels;
  RoomMap rooms;
};

/// All that a label stage knows, moved; polygons of the room are known to be in it.
Scene scene_of(const PlanMaker& plan, const Pose& world_from_plan = Pose::Identity()) {
  Scene scene{plan.moved(world_from_plan), {}, {}};
  for (const std::string& text : plan.labels) {
    PolygonLabel label{Label::unknown, 0.95};
    for (const Label one : all_labels)
      if (text == name(one)) label.label = one;
    scene.labels.polygons.push_back(label);
  }
  scene.rooms.rooms.resize(1);
  scene.rooms.room_of_polygon.assign(plan.labels.size(), -1);
  std::fill_n(scene.rooms.room_of_polygon.begin(), furnished_room().labels.size(), 0);
  Opening window;
  window.kind = OpeningKind::window;
  window.rooms = {0};
  window.position = world_from_plan * Vector3d(5.15, 2, 1.5);
  window.across = world_from_plan.linear() * Vector3d(1, 0, 0);
  window.width = 1.4;
  window.height = 1.2;
  window.thickness = 0.3;
  scene.rooms.openings = {window};
  return scene;
}

std::vector<Label> plain(const Labels& labels) {
  std::vector<Label> found;
  for (const PolygonLabel& polygon : labels.polygons) found.push_back(polygon.label);
  return found;
}

TEST(Reflections, BehindAWindowBecomeUnknown) {
  PlanMaker plan = furnished_room();
  const std::vector<std::string> labels = plan.labels;
  const std::size_t real = labels.size();
  add_mirror_image(plan, labels);
  for (const double turn : {0.0, 0.3, 2.0}) {
    const Scene scene = scene_of(plan, pose_from_xyz_ypr({3, -7, 1}, turn, 0, 0));
    const auto before = plain(scene.labels);
    const auto after = plain(without_reflections(scene.map, scene.labels, scene.rooms));
    for (std::size_t i = 0; i < after.size(); ++i) {
      // The wall with the window, its image, and the cupboard's sides that face away from it.
      const bool faces_window =
          scene.map.polygons[i].plane.signed_distance(scene.rooms.openings[0].position) > 0;
      EXPECT_EQ(after[i], i >= real && faces_window ? Label::unknown : before[i]) << i;
    }
  }
}

TEST(Reflections, AreNoRoomsOfTheirOwn) {
  // A room beyond the window that is no mirror image keeps its labels.
  PlanMaker plan = furnished_room();
  plan.add_room({5.3, -1, 0}, {9, 3.2, 2.4});
  const Scene scene = scene_of(plan);
  EXPECT_EQ(plain(without_reflections(scene.map, scene.labels, scene.rooms)), plain(scene.labels));
}

TEST(Reflections, AreNotWhatSomebodyEntered) {
  PlanMaker plan = furnished_room();
  const std::vector<std::string> labels = plan.labels;
  add_mirror_image(plan, labels);
  Scene scene = scene_of(plan);
  scene.rooms.rooms.resize(2);
  std::fill(scene.rooms.room_of_polygon.begin() + static_cast<std::ptrdiff_t>(labels.size()),
            scene.rooms.room_of_polygon.end(), 1);
  EXPECT_EQ(plain(without_reflections(scene.map, scene.labels, scene.rooms)), plain(scene.labels));
}

TEST(Reflections, AreNotTheFloorOfATerrace) {
  // It goes on at the level of the room's, as a mirror image would.
  PlanMaker plan = furnished_room();
  plan.add("floor", {{5.3, 0, 0}, {8, 0, 0}, {8, 4, 0}, {5.3, 4, 0}});
  const Scene scene = scene_of(plan);
  EXPECT_EQ(plain(without_reflections(scene.map, scene.labels, scene.rooms)), plain(scene.labels));
}

TEST(Reflections, NeedLabelsAndRoomsOfTheMap) {
  const Scene scene = scene_of(furnished_room());
  EXPECT_THROW(without_reflections(scene.map, {}, scene.rooms), Error);
  EXPECT_THROW(without_reflections(scene.map, scene.labels, {}), Error);
}

}  // namespace
}  // namespace planum
