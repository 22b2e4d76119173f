#include "labeling/objects/objects.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "labeling/objects/object_models.hpp"
#include "slam/core/error.hpp"
#include "slam/core/parallel.hpp"
#include "slam/sensor/furniture.hpp"
#include "tests/labeling/plans.hpp"
#include "tests/labeling/scanned_building.hpp"
#include "tools/objects/model_library.hpp"

namespace planum {
namespace {

using testing::moved;
using testing::PlanMaker;
using testing::scanned;
using testing::ScannedWorld;

constexpr double table_turn = radians(20), chair_turn = radians(-130);

/// A room with a table, a chair and a cabinet that stands against a wall, seen from four places
/// above the table.
struct FurnishedRoom {
  ScannedWorld world;
  PolygonMap map;
  Labels labels;
  RoomMap rooms;

  FurnishedRoom moved(const Pose& b_from_a) const {
    FurnishedRoom result{testing::moved(world, b_from_a), map, labels, rooms};
    for (Eigen::Vector3d& p : result.map.vertices) p = b_from_a * p;
    for (MapPolygon& polygon : result.map.polygons) {
      polygon.plane.normal = b_from_a.linear() * polygon.plane.normal;
      polygon.plane.offset += polygon.plane.normal.dot(b_from_a.translation());
    }
    for (Eigen::Vector3d& p : result.rooms.rooms[0].outline) p = b_from_a * p;
    return result;
  }
};

FurnishedRoom scanned_room() {
  const std::vector<Eigen::Vector2d> walls = {{0, 0}, {5, 0}, {5, 4}, {0, 4}};
  BuildingPlan building{.name = "room", .rooms = {{"room", {.outer = walls}, 2.6}}};
  for (const auto& boxes : {table({1.5, 1.4}, {1.4, 0.8}, table_turn),
                            chair({3.4, 2.9}, chair_turn), cabinet({4.74, 1.2}, {0.5, 1.2}, 1.5)})
    building.furniture.insert(building.furniture.end(), boxes.begin(), boxes.end());

  std::vector<Pose> poses;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0.6, 3.3, -40), Eigen::Vector3d(3.3, 0.7, 150),
        Eigen::Vector3d(2.4, 3.4, -60), Eigen::Vector3d(4.4, 3.3, -140)})
    poses.push_back(pose_from_xyz_ypr({place.x(), place.y(), 1.3}, radians(place.z()), 0, 0));

  FurnishedRoom room;
  room.world = scanned(built(building).mesh.mesh, poses, {.beams = 361, .slices = 160});
  PlanMaker plan;
  plan.add_room({0, 0, 0}, {5, 4, 2.6});
  plan.add_furniture({4.49, 0.6, 0}, {4.99, 1.8, 1.5});
  room.map = plan.moved(Pose::Identity());
  for (const std::string& word : plan.labels)
    for (const Label label : all_labels)
      if (name(label) == word) room.labels.polygons.push_back({label, 1});
  room.rooms.rooms.resize(1);
  room.rooms.rooms[0].height = 2.6;
  for (const Eigen::Vector2d& p : walls) room.rooms.rooms[0].outline.emplace_back(p.x(), p.y(), 0);
  return room;
}

const FurnishedRoom& furnished() {
  static const FurnishedRoom room = scanned_room();
  return room;
}

std::vector<SceneObject> found(const FurnishedRoom& room, const ObjectParams& params = {}) {
  return find_objects(room.world.cloud, room.map, room.labels, room.rooms, params);
}

std::vector<SceneObject> recognized(const FurnishedRoom& room) {
  return with_models(found(room), room.world.cloud, room.world.origins, built_in_models());
}

/// The object nearest to a place in plan, or null if none is within 30 cm.
const SceneObject* object_at(const std::vector<SceneObject>& objects,
                             const Eigen::Vector3d& place) {
  for (const SceneObject& object : objects)
    if ((object.box.centre - place).head<2>().norm() < 0.3) return &object;
  return nullptr;
}

double heading(const Eigen::Vector3d& direction) {
  return std::atan2(direction.y(), direction.x());
}

/// rad, between two directions that are the same after a turn by `period`.
double difference(double a, double b, double period) {
  return std::abs(std::remainder(a - b, period));
}

void expect_box(const SceneObject* object, const Eigen::Vector3d& centre,
                const Eigen::Vector3d& size, double turn, double period) {
  ASSERT_TRUE(object);
  EXPECT_LT((object->box.centre - centre).norm(), 0.04) << object->box.centre.transpose();
  EXPECT_LT((object->box.size - size).cwiseAbs().maxCoeff(), 0.07) << object->box.size.transpose();
  EXPECT_LT(degrees(difference(heading(object->box.along), turn, period)), 3);
  EXPECT_TRUE(object->is_on_floor);
  EXPECT_EQ(object->room, 0u);
}

TEST(Objects, HaveTheBoxesOfTheFurniture) {
  const auto objects = found(furnished());
  EXPECT_EQ(objects.size(), 3u);
  expect_box(object_at(objects, {1.5, 1.4, 0}), {1.5, 1.4, 0.37}, {1.4, 0.8, 0.74}, table_turn, pi);
  expect_box(object_at(objects, {3.4, 2.9, 0}), {3.4, 2.9, 0.45}, {0.42, 0.42, 0.9}, chair_turn,
             pi / 2);
  expect_box(object_at(objects, {4.74, 1.2, 0}), {4.745, 1.2, 0.75}, {1.2, 0.51, 1.5}, pi / 2, pi);
}

TEST(Objects, KnowThePolygonsInTheirBoxes) {
  const auto objects = found(furnished());
  const SceneObject* cabinet = object_at(objects, {4.74, 1.2, 0});
  ASSERT_TRUE(cabinet);
  EXPECT_EQ(cabinet->polygons, (std::vector<std::uint32_t>{6, 7, 8, 9, 10}));
  EXPECT_TRUE(object_at(objects, {1.5, 1.4, 0})->polygons.empty());
}

TEST(Objects, AreOfPointsInsideTheRoomThatLieOnNoWall) {
  for (const SceneObject& object : found(furnished()))
    for (const std::uint32_t i : object.points) {
      const Eigen::Vector3d p = furnished().world.cloud.points[i].cast<double>();
      EXPECT_TRUE((p.array() > 0.05).all() && p.x() < 4.95 && p.y() < 3.95) << p.transpose();
    }
}

TEST(Objects, MatchTheModelsOfTheirKinds) {
  const auto objects = recognized(furnished());
  const struct {
    const char* name;
    Eigen::Vector3d place;
    double turn, period;
  } expected[] = {{"table", {1.5, 1.4, 0}, table_turn, pi},
                  {"chair", {3.4, 2.9, 0}, chair_turn, 2 * pi},
                  {"cabinet", {4.74, 1.2, 0}, pi / 2, pi}};
  for (const auto& truth : expected) {
    SCOPED_TRACE(truth.name);
    const SceneObject* object = object_at(objects, truth.place);
    ASSERT_TRUE(object && object->model);
    const ModelMatch& match = *object->model;
    EXPECT_EQ(match.name, truth.name);
    EXPECT_GT(match.score(), 0.75);
    EXPECT_LT((match.world_from_model.translation() - truth.place).norm(), 0.04);
    const Eigen::Vector3d x = match.world_from_model.linear().col(0);
    EXPECT_LT(degrees(difference(heading(x), truth.turn, truth.period)), 4);
  }
}

TEST(Objects, MoveAndTurnWithTheScene) {
  const auto before = recognized(furnished());
  for (const double turn : {37.0, 161.0, 250.0}) {
    const Pose pose = pose_from_xyz_ypr({12, -7, 1.5}, radians(turn), 0, 0);
    const auto after = recognized(furnished().moved(pose));
    ASSERT_EQ(after.size(), before.size());
    for (const SceneObject& object : before) {
      const SceneObject* other = object_at(after, pose * object.box.centre);
      ASSERT_TRUE(other);
      EXPECT_LT((other->box.centre - pose * object.box.centre).norm(), 0.03);
      EXPECT_LT((other->box.size - object.box.size).norm(), 0.06);
      ASSERT_TRUE(other->model && object.model);
      EXPECT_EQ(other->model->name, object.model->name);
      EXPECT_NEAR(other->model->score(), object.model->score(), 0.1);
    }
  }
}

TEST(Objects, OneThreadGivesTheSameAsMany) {
  const int threads = thread_count();
  set_thread_count(1);
  const auto one = recognized(furnished());
  set_thread_count(4);
  const auto many = recognized(furnished());
  set_thread_count(threads);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].points, many[i].points);
    EXPECT_EQ(one[i].box.centre, many[i].box.centre);
    EXPECT_EQ(one[i].box.size, many[i].box.size);
    EXPECT_EQ(one[i].model->world_from_model.matrix(), many[i].model->world_from_model.matrix());
  }
}

TEST(Objects, AreNoneWhereNothingIs) {
  EXPECT_TRUE(find_objects({}, {}, {}, {}).empty());
  FurnishedRoom room = furnished();
  room.rooms = {};
  EXPECT_TRUE(found(room).empty());
  room = furnished();
  room.world.cloud = {};
  EXPECT_TRUE(found(room).empty());
  EXPECT_TRUE(with_models({}, {}, {}, built_in_models()).empty());
}

TEST(Objects, NeedPointsWithNormals) {
  FurnishedRoom room = furnished();
  for (Eigen::Vector3f& normal : room.world.cloud.normals) normal.setZero();
  EXPECT_TRUE(found(room).empty());
}

TEST(Objects, AModelThatFitsBadlyIsNoMatch) {
  std::vector<ObjectModel> models = built_in_models();
  models.erase(models.begin() + 2);  // the cabinet
  const auto objects =
      with_models(found(furnished()), furnished().world.cloud, furnished().world.origins, models);
  const SceneObject* cabinet = object_at(objects, {4.74, 1.2, 0});
  ASSERT_TRUE(cabinet);
  EXPECT_FALSE(cabinet->model);
}

template <class Function>
std::string message_of(Function function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Objects, NameTheParameterThatIsOutOfRange) {
  const auto message = [](const ObjectParams& params) {
    return message_of([&] { found(furnished(), params); });
  };
  EXPECT_EQ(message({.clearance = 0}), "objects: clearance is 0 m, must be 0.005 to 10");
  EXPECT_EQ(message({.cell = -1}), "objects: cell is -1 m, must be 0.005 to 10");
  EXPECT_EQ(message({.max_stray = 0.5}), "objects: max_stray is 0.5, must be 0 to 0.25");
  FurnishedRoom room = furnished();
  room.labels.polygons.pop_back();
  EXPECT_EQ(message_of([&] { found(room); }), "objects: 11 polygons with 10 labels");
  room.world.cloud.normals.clear();
  EXPECT_EQ(message_of([&] { found(room); }), "objects: the cloud needs a normal for each point");
}

TEST(Objects, NameTheModelThatCannotBeUsed) {
  const auto message = [](const std::vector<ObjectModel>& models, const MatchParams& params) {
    return message_of([&] {
      with_models({}, furnished().world.cloud, furnished().world.origins, models, params);
    });
  };
  EXPECT_EQ(message({}, {.tolerance = 0}), "models: tolerance is 0 m, must be 0.005 to 1");
  EXPECT_EQ(message({}, {.min_score = 2}), "models: min_score is 2, must be 0 to 1");
  EXPECT_EQ(message({{.name = "ghost", .mesh = {}}}, {}), "models: 'ghost' has no surface");
}

TEST(OrientedBox, TwoSidesOfABlockGiveItsDirection) {
  std::vector<Eigen::Vector2d> sides;
  for (int i = 0; i <= 40; ++i) {
    sides.emplace_back(0.05 * i, 0);
    if (i <= 12) sides.emplace_back(0, 0.05 * i);
  }
  for (Eigen::Vector2d& p : sides) p = Eigen::Rotation2Dd(0.3) * p;
  EXPECT_NEAR(difference(direction_of_rectangle(sides), 0.3, pi / 2), 0, 1e-6);
}

TEST(OrientedBox, HullHasCornersOnly) {
  const auto hull = convex_hull({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}, {0, 0}});
  ASSERT_EQ(hull.size(), 4u);
  EXPECT_EQ(hull[0], Eigen::Vector2d(0, 0));
  EXPECT_EQ(hull[1], Eigen::Vector2d(2, 0));
  EXPECT_EQ(direction_of_rectangle({}), 0);
  EXPECT_EQ(direction_of_rectangle({{1, 1}, {1, 1}}), 0);
}

}  // namespace
}  // namespace planum
