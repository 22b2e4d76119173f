#include "slam/sensor/building.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "slam/core/cloud.hpp"
#include "slam/core/kd_tree.hpp"
#include "slam/core/pose.hpp"
#include "slam/sensor/demo_building.hpp"
#include "slam/sensor/furniture.hpp"
#include "slam/sensor/random_building.hpp"
#include "slam/sensor/ray_caster.hpp"
#include "slam/sensor/simulator.hpp"
#include "slam/sensor/tilted_laser.hpp"
#include "tests/slam/sensor/sensor_test_support.hpp"

namespace planum {
namespace {

/// Two rooms, a door between them, and walls that are not at right angles.
BuildingPlan two_rooms() {
  return {.rooms = {{"left", {.outer = {{0, 0}, {4, 0}, {4, 3}, {1, 3.5}}}, 2.8},
                    {"right", {.outer = {{4.2, -1}, {8, 0}, {7, 4}, {4.2, 3}}}, 2.5}},
          .doors = {{{"left", "right"}, {4.1, 1.2}, 0.9, 2.0}}};
}

std::string group_of(const LabelledMesh& mesh, std::size_t triangle) {
  return mesh.names[mesh.group[triangle]];
}

Eigen::Vector3d corner(const LabelledMesh& mesh, std::size_t triangle, std::size_t k) {
  return mesh.mesh.vertices[mesh.mesh.triangles[triangle][k]].cast<double>();
}

/// Edges of a triangle without a neighbour that has the same edge the other way round, by the group
/// of the triangle.
std::map<std::string, int> open_edges(const LabelledMesh& mesh) {
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
  std::map<std::string, int> open;
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i) {
    const auto& t = mesh.mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(edges.count({t[k], t[(k + 1) % 3]}), 1u);
      if (edges.count({t[(k + 1) % 3], t[k]}) != 1) ++open[group_of(mesh, i)];
    }
  }
  return open;
}

/// Positive if triangles face outwards.
double signed_volume(const LabelledMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i)
    sum += corner(mesh, i, 0).dot(corner(mesh, i, 1).cross(corner(mesh, i, 2))) / 6;
  return sum;
}

double area_of(const LabelledMesh& mesh, const std::string& group) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.mesh.triangles.size(); ++i)
    if (group_of(mesh, i) == group)
      sum += (corner(mesh, i, 1) - corner(mesh, i, 0))
                 .cross(corner(mesh, i, 2) - corner(mesh, i, 0))
                 .norm() /
             2;
  return sum;
}

TEST(Building, SurfacesEncloseTheFreeSpace) {
  const Building building = built(two_rooms());
  EXPECT_TRUE(open_edges(building.mesh).empty());
  double volume = 0.9 * 2.0 * 0.2;  // in the door
  for (const TrueRoom& room : building.rooms) volume += room.area * room.height;
  EXPECT_NEAR(signed_volume(building.mesh), -volume, 1e-4);
}

TEST(Building, WindowsAreTheOnlyHoles) {
  BuildingPlan plan = two_rooms();
  plan.windows = {{"left", {2, 0}}, {"right", {7.5, 2}}, {"right", {6, -0.5}}};
  const Building building = built(plan);
  EXPECT_EQ(open_edges(building.mesh), (std::map<std::string, int>{{"window", 12}}));
  EXPECT_NEAR(area_of(building.mesh, "window"), 3 * 0.3 * 2 * (1.2 + 1.3), 1e-4);
}

TEST(Building, SurfacesHaveTheirAreas) {
  const Building building = built(two_rooms());
  const double rooms = building.rooms[0].area + building.rooms[1].area;
  EXPECT_NEAR(area_of(building.mesh, "floor"), rooms + 0.9 * 0.2, 1e-4);
  EXPECT_NEAR(area_of(building.mesh, "ceiling"), rooms, 1e-4);
  EXPECT_NEAR(area_of(building.mesh, "lintel"), 0.9 * 0.2, 1e-5);
  EXPECT_NEAR(area_of(building.mesh, "jamb"), 2 * 2.0 * 0.2, 1e-5);
  EXPECT_EQ(area_of(building.mesh, "clutter"), 0);
}

TEST(Building, FurnitureIsClosedAndLooksOutwards) {
  BuildingPlan plan;
  for (const auto& boxes : {table({0, 0}, {1, 0.6}, 0.4), chair({2, 0}, 1),
                            cabinet({4, 0}, {0.5, 1}, 2), sofa({7, 0}, 2, -0.3)})
    plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
  const Building building = built(plan);
  double volume = 0;
  for (const Box& box : plan.furniture) volume += box.size.prod();
  EXPECT_NEAR(signed_volume(building.mesh), volume, 1e-5);
}

TEST(Building, TurningTurnsMeshAndTruth) {
  BuildingPlan plan = two_rooms();
  const Building straight = built(plan);
  plan.turn = 1.1;
  const Building turned = built(plan);
  const Eigen::AngleAxisd rotation(1.1, Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < straight.mesh.mesh.vertices.size(); ++i)
    EXPECT_LT((rotation * straight.mesh.mesh.vertices[i].cast<double>() -
               turned.mesh.mesh.vertices[i].cast<double>())
                  .norm(),
              1e-5);
  EXPECT_LT((rotation * straight.doors[0].centre - turned.doors[0].centre).norm(), 1e-9);
  EXPECT_EQ(straight.rooms[1].width, turned.rooms[1].width);
}

/// Distance between the surfaces that a point sees in two opposite directions.
double clear_span(const RayCaster& caster, const Eigen::Vector3d& p, const Eigen::Vector3d& along) {
  double sum = 0;
  for (const double sign : {-1.0, 1.0}) {
    const auto hit = caster.cast(p, sign * along, 100);
    sum += hit ? hit->distance : 1000;
  }
  return sum;
}

/// The directions along and across the walls of a building that stood on the axes before its turn.
std::array<Eigen::Vector3d, 2> main_directions(const Building& building) {
  const Eigen::AngleAxisd rotation(building.turn, Eigen::Vector3d::UnitZ());
  return {rotation * Eigen::Vector3d::UnitX(), rotation * Eigen::Vector3d::UnitY()};
}

void expect_true_doors(const Building& building) {
  const RayCaster caster(building.mesh.mesh);
  const auto [x, y] = main_directions(building);
  for (const TrueDoor& door : building.doors) {
    SCOPED_TRACE(door.between[0] + "-" + door.between[1]);
    const double spans[] = {clear_span(caster, door.centre, x), clear_span(caster, door.centre, y)};
    EXPECT_NEAR(std::min(spans[0], spans[1]), door.width, 1e-4);
    EXPECT_GT(std::max(spans[0], spans[1]), 1.5) << "blocked";
    EXPECT_NEAR(clear_span(caster, door.centre, Eigen::Vector3d::UnitZ()), door.height, 1e-4);
  }
}

void expect_true_room(const Building& building, const TrueRoom& room) {
  SCOPED_TRACE(room.name);
  const RayCaster caster(building.mesh.mesh);
  const auto [x, y] = main_directions(building);
  // Above doors, windows and furniture.
  const Eigen::Vector3d p(room.centre.x(), room.centre.y(), 2.35);
  const double spans[] = {clear_span(caster, p, x), clear_span(caster, p, y)};
  EXPECT_NEAR(std::min(spans[0], spans[1]), room.width, 1e-4);
  EXPECT_NEAR(std::max(spans[0], spans[1]), room.depth, 1e-4);
  EXPECT_NEAR(caster.cast(p, Eigen::Vector3d::UnitZ(), 10)->distance, room.height - 2.35, 1e-4);
  EXPECT_NEAR(room.area, room.width * room.depth, 1e-9);
}

/// Stops stand in free space, see surfaces from the front only, and can be reached one from
/// another.
void expect_drivable(const Building& building, const std::vector<Pose>& poses) {
  const RayCaster caster(building.mesh.mesh);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    SCOPED_TRACE(i);
    for (const double z : {0.15, 0.45, 0.59, 0.73}) {
      const Eigen::Vector3d p(poses[i].translation().x(), poses[i].translation().y(), z);
      for (int k = 0; k < 72; ++k) {
        const double a = radians(5 * k);
        const Eigen::Vector3d direction(std::cos(a), std::sin(a), 0);
        const auto hit = caster.cast(p, direction, 100);
        if (!hit) continue;  // out of a window
        ASSERT_GT(hit->distance, 0.25);
        ASSERT_LT(hit->normal.cast<double>().dot(direction), 0) << "sees the back of a surface";
      }
      if (i == 0) continue;
      const Eigen::Vector3d last(poses[i - 1].translation().x(), poses[i - 1].translation().y(), z);
      ASSERT_FALSE(caster.cast(last, (p - last).normalized(), (p - last).norm())) << "at " << z;
    }
    EXPECT_NEAR(poses[i].translation().z(), 0.6, 0.05);
    if (i == 0) continue;
    EXPECT_LE((poses[i].translation() - poses[i - 1].translation()).norm(), 2.5);
    EXPECT_LE(rotation_angle(poses[i - 1], poses[i]), radians(40.5));
  }
}

TEST(DemoBuilding, IsClosedButForItsWindows) {
  const BuildingPlan plan = demo_plan();
  EXPECT_EQ(open_edges(demo_building().mesh),
            (std::map<std::string, int>{{"window", 4 * static_cast<int>(plan.windows.size())}}));
}

TEST(DemoBuilding, TruthIsWhatStandsThere) {
  const Building building = demo_building();
  const BuildingPlan plan = demo_plan();
  ASSERT_EQ(building.rooms.size(), 7u);
  EXPECT_EQ(building.doors.size(), 10u);
  expect_true_doors(building);
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    if (plan.rooms[i].walls.holes.empty()) expect_true_room(building, building.rooms[i]);
  const TrueRoom& corridor = building.rooms[0];
  EXPECT_NEAR(corridor.area, 7.05 * 4.65 - 4.05 * 1.65, 1e-9);
}

TEST(DemoBuilding, PathIsDrivableAndClosesALoop) {
  const std::vector<Pose> poses = demo_poses();
  EXPECT_EQ(poses.size(), 26u);
  expect_drivable(demo_building(), poses);
  EXPECT_LT((poses[21].translation() - poses[0].translation()).norm(), 0.5);
}

TEST(DemoBuilding, PathEntersEveryRoom) {
  const Building building = demo_building();
  const std::vector<Pose> poses = demo_poses();
  const Eigen::Rotation2Dd plan_from_building(-building.turn);
  for (const RoomPlan& room : demo_plan().rooms) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner_in_plan : room.walls.outer) box.extend(corner_in_plan);
    const bool entered = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
      return box.contains(plan_from_building * pose.translation().head<2>().eval());
    });
    EXPECT_TRUE(entered) << room.name;
  }
}

/// Share of a scan's points within 10 cm of the other's, one point a 5 cm voxel.
double overlap(const std::vector<Eigen::Vector3f>& scan,
               const std::vector<Eigen::Vector3f>& other) {
  const KdTree tree(other);
  std::map<std::array<int, 3>, bool> voxels;
  for (const Eigen::Vector3f& p : scan) {
    const Eigen::Vector3i v = (20 * p).array().floor().matrix().cast<int>();
    if (const std::array<int, 3> key{v.x(), v.y(), v.z()}; !voxels.contains(key))
      voxels[key] = tree.nearest(p, 0.1f).has_value();
  }
  const auto near = std::count_if(voxels.begin(), voxels.end(), [](auto& v) { return v.second; });
  return static_cast<double>(near) / static_cast<double>(voxels.size());
}

TEST(DemoBuilding, ConsecutiveScansOverlap) {
  const Building building = demo_building();
  const std::vector<Pose> poses = demo_poses();
  const auto scans = simulate_scans(building.mesh.mesh, poses, {.beams = 181, .slices = 126});
  std::vector<Eigen::Vector3f> last;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto points = transformed(points_from_slices(scans[i].scan).cloud, poses[i]).points;
    if (i > 0) {
      EXPECT_GT(overlap(points, last), 0.35) << "scan " << i;
    }
    last = points;
  }
}

TEST(RandomBuilding, IsSoundForManySeeds) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const auto [building, poses] = random_building(seed, 1 + seed % 6);
    const int windows = static_cast<int>(building.rooms.size()) - 1;
    EXPECT_EQ(open_edges(building.mesh), (std::map<std::string, int>{{"window", 4 * windows}}));
    expect_true_doors(building);
    for (const TrueRoom& room : building.rooms) expect_true_room(building, room);
    expect_drivable(building, poses);
  }
}

TEST(RandomBuilding, SameSeedSameBuilding) {
  EXPECT_EQ(random_building(3).building.mesh.mesh.vertices,
            random_building(3).building.mesh.mesh.vertices);
  EXPECT_NE(random_building(3).building.rooms[0].width, random_building(4).building.rooms[0].width);
  EXPECT_EQ(message_of([] { random_building(1, 0); }), "a building without rooms");
}

TEST(Building, SaysWhatDoesNotFit) {
  const auto message = [](const auto& change) {
    BuildingPlan plan = two_rooms();
    change(plan);
    return message_of([&] { built(plan); });
  };
  EXPECT_EQ(message([](BuildingPlan& p) { p.doors[0].between[1] = "cellar"; }),
            "door between left and cellar at (4.10, 1.20): there is no room \"cellar\"");
  EXPECT_EQ(message([](BuildingPlan& p) { p.doors[0].height = 2.6; }),
            "door between left and right at (4.10, 1.20): it does not fit into a wall of 4.00 m x "
            "2.50 m");
  EXPECT_EQ(message([](BuildingPlan& p) {
              p.doors[0].centre = {2, 0};
            }),
            "door between left and right at (2.00, 0.00): the two rooms have no wall in common "
            "there");
  EXPECT_EQ(message([](BuildingPlan& p) { p.doors.push_back(p.doors[0]); }),
            "door between left and right at (4.10, 1.20): it overlaps another opening of its wall");
  EXPECT_EQ(message([](BuildingPlan& p) {
              p.windows = {{"left", {3.5, 0}}};
            }),
            "window of left at (3.50, 0.00): it does not fit into a wall of 4.00 m x 2.80 m");
}

}  // namespace
}  // namespace planum
