#include "slam/sensor/building.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/core/pose.hpp"
#include "slam/sensor/surface_builder.hpp"

namespace planum {
namespace {

constexpr double max_wall_thickness = 1.0;  // m, rooms farther apart are not neighbours
constexpr double min_margin = 0.01;         // m, between an opening and the end of its wall

/// A rectangle cut out of a wall: s along the wall from its first corner, z up.
struct Cut {
  double s0, s1, z0, z1;  ///< m
};

/// One wall face; the room lies to the left of the way from a to b.
struct Wall {
  Eigen::Vector2d a, b;
  double height = 0;
  std::vector<Cut> cuts;

  double length() const { return (b - a).norm(); }
  Eigen::Vector2d along() const { return (b - a).normalized(); }
  Eigen::Vector2d at(double s) const { return a + s * along(); }
  Eigen::Vector2d inwards() const { return {-along().y(), along().x()}; }
  double distance(const Eigen::Vector2d& p) const {
    const double s = std::clamp((p - a).dot(along()), 0.0, length());
    return (p - at(s)).norm();
  }
};

/// The walls of each room, ring by ring.
using RoomWalls = std::vector<std::vector<Wall>>;

Eigen::Vector3d raised(const Eigen::Vector2d& p, double z) { return {p.x(), p.y(), z}; }

RoomWalls walls_of(const RoomPlan& room) {
  const PlanPolygon polygon = oriented(room.walls);
  RoomWalls rings;
  const auto add_ring = [&](const std::vector<Eigen::Vector2d>& ring) {
    auto& walls = rings.emplace_back();
    for (std::size_t i = 0; i < ring.size(); ++i)
      walls.push_back({ring[i], ring[(i + 1) % ring.size()], room.height, {}});
  };
  add_ring(polygon.outer);
  for (const auto& hole : polygon.holes) add_ring(hole);
  return rings;
}

std::size_t room_index(const BuildingPlan& plan, const std::string& name) {
  for (std::size_t i = 0; i < plan.rooms.size(); ++i)
    if (plan.rooms[i].name == name) return i;
  throw Error(fmt::format("there is no room \"{}\"", name));
}

Wall& nearest_wall(RoomWalls& rings, const Eigen::Vector2d& p) {
  Wall* nearest = &rings.front().front();
  for (auto& ring : rings)
    for (Wall& wall : ring)
      if (wall.distance(p) < nearest->distance(p)) nearest = &wall;
  return *nearest;
}

/// Cuts an opening of a width into a wall, centred at the foot of a point.
const Cut& cut_wall(Wall& wall, const Eigen::Vector2d& centre, double width, double z0, double z1) {
  const double s = (centre - wall.a).dot(wall.along());
  const Cut cut{s - width / 2, s + width / 2, z0, z1};
  if (!(width > 0 && z1 > z0 && z0 >= 0)) throw Error("its size is not positive");
  if (cut.s0 < min_margin || cut.s1 > wall.length() - min_margin || z1 > wall.height - min_margin)
    throw Error(fmt::format("it does not fit into a wall of {:.2f} m x {:.2f} m", wall.length(),
                            wall.height));
  for (const Cut& other : wall.cuts)
    if (cut.s0 < other.s1 + min_margin && other.s0 < cut.s1 + min_margin)
      throw Error("it overlaps another opening of its wall");
  return wall.cuts.emplace_back(cut);
}

/// Floor, jambs and lintel between the two wall faces that a door goes through.
TrueDoor build_door(const DoorPlan& door, RoomWalls& first, RoomWalls& second,
                    SurfaceBuilder& builder) {
  Wall& a = nearest_wall(first, door.centre);
  Wall& b = nearest_wall(second, door.centre);
  const double thickness = a.inwards().dot(a.a - b.a);
  if (a.along().dot(b.along()) > -1 + 1e-9 || thickness < min_margin ||
      thickness > max_wall_thickness)
    throw Error("the two rooms have no wall in common there");
  const Cut& in_a = cut_wall(a, door.centre, door.width, 0, door.height);
  const Cut& in_b = cut_wall(b, door.centre, door.width, 0, door.height);
  const Eigen::Vector2d a0 = a.at(in_a.s0), a1 = a.at(in_a.s1);
  const Eigen::Vector2d b0 = b.at(in_b.s0), b1 = b.at(in_b.s1);
  // b runs the other way: b1 is opposite a0.
  const double h = door.height;
  builder.add_quad("floor", {raised(a0, 0), raised(b1, 0), raised(b0, 0), raised(a1, 0)});
  builder.add_quad("lintel", {raised(a0, h), raised(a1, h), raised(b0, h), raised(b1, h)});
  builder.add_quad("jamb", {raised(a0, 0), raised(a0, h), raised(b1, h), raised(b1, 0)});
  builder.add_quad("jamb", {raised(a1, 0), raised(b0, 0), raised(b0, h), raised(a1, h)});
  return {door.between, door.width, door.height, raised((a0 + a1 + b0 + b1) / 4, h / 2)};
}

/// Sill, head and sides of a window, out to the outer face of the wall.
void build_window(const WindowPlan& window, double thickness, RoomWalls& room,
                  SurfaceBuilder& builder) {
  Wall& wall = nearest_wall(room, window.centre);
  const double top = window.sill + window.height;
  const Cut& cut = cut_wall(wall, window.centre, window.width, window.sill, top);
  const std::array<Eigen::Vector3d, 4> inner{
      raised(wall.at(cut.s0), cut.z0), raised(wall.at(cut.s1), cut.z0),
      raised(wall.at(cut.s1), cut.z1), raised(wall.at(cut.s0), cut.z1)};
  const Eigen::Vector3d outwards = -thickness * raised(wall.inwards(), 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d& p = inner[i];
    const Eigen::Vector3d& q = inner[(i + 1) % 4];
    builder.add_quad("window", {p, p + outwards, q + outwards, q});
  }
}

/// The wall's outline in s and z, with notches where doors stand on the floor and holes elsewhere.
PlanPolygon outline(const Wall& wall) {
  std::vector<Cut> cuts = wall.cuts;
  std::sort(cuts.begin(), cuts.end(), [](const Cut& p, const Cut& q) { return p.s0 < q.s0; });
  PlanPolygon polygon{.outer = {{0, 0}}};
  for (const Cut& c : cuts) {
    const std::vector<Eigen::Vector2d> corners{
        {c.s0, c.z0}, {c.s0, c.z1}, {c.s1, c.z1}, {c.s1, c.z0}};
    if (c.z0 == 0)
      polygon.outer.insert(polygon.outer.end(), corners.begin(), corners.end());
    else
      polygon.holes.push_back(corners);
  }
  const double length = wall.length();
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(length, 0), {length, wall.height}, {0, wall.height}})
    polygon.outer.push_back(corner);
  return polygon;
}

/// The floor's corners: those of the walls and of the doors between them.
std::vector<Eigen::Vector2d> floor_ring(const std::vector<Wall>& walls) {
  std::vector<Eigen::Vector2d> ring;
  for (const Wall& wall : walls) {
    std::vector<double> stops{0};
    for (const Cut& cut : wall.cuts)
      if (cut.z0 == 0) stops.insert(stops.end(), {cut.s0, cut.s1});
    std::sort(stops.begin(), stops.end());
    for (const double s : stops) ring.push_back(wall.at(s));
  }
  return ring;
}

void build_room(const RoomPlan& room, const RoomWalls& rings, SurfaceBuilder& builder) {
  PlanPolygon floor;
  floor.outer = floor_ring(rings.front());
  for (std::size_t i = 1; i < rings.size(); ++i) floor.holes.push_back(floor_ring(rings[i]));
  for (const auto& [a, b, c] : triangulated(floor))
    builder.add_triangle("floor", {raised(a, 0), raised(b, 0), raised(c, 0)});
  const double h = room.height;
  for (const auto& [a, b, c] : triangulated(room.walls))
    builder.add_triangle("ceiling", {raised(a, h), raised(c, h), raised(b, h)});
  for (const auto& ring : rings)
    for (const Wall& wall : ring)
      // Seen from the room, s runs from right to left.
      for (const auto& [a, b, c] : triangulated(outline(wall)))
        builder.add_triangle("wall", {raised(wall.at(a.x()), a.y()), raised(wall.at(c.x()), c.y()),
                                      raised(wall.at(b.x()), b.y())});
}

TrueRoom true_room(const RoomPlan& room) {
  const PlanRectangle rectangle = smallest_rectangle(room.walls);
  return {room.name,   rectangle.width,  rectangle.depth,
          room.height, area(room.walls), rectangle.centre};
}

/// Turns the finished building about the origin.
void turn(Building& building) {
  const Eigen::Rotation2Dd rotation(building.turn);
  for (Eigen::Vector3f& v : building.mesh.mesh.vertices)
    v.head<2>() = (rotation * v.head<2>().cast<double>()).cast<float>();
  for (TrueRoom& room : building.rooms) room.centre = rotation * room.centre;
  for (TrueDoor& door : building.doors) door.centre.head<2>() = rotation * door.centre.head<2>();
}

}  // namespace

Building built(const BuildingPlan& plan) {
  Building building{.name = plan.name, .turn = plan.turn};
  SurfaceBuilder builder;
  std::vector<RoomWalls> walls;
  for (const RoomPlan& room : plan.rooms) walls.push_back(walls_of(room));
  for (const DoorPlan& door : plan.doors) {
    try {
      RoomWalls& first = walls[room_index(plan, door.between[0])];
      RoomWalls& second = walls[room_index(plan, door.between[1])];
      building.doors.push_back(build_door(door, first, second, builder));
    } catch (Error& e) {
      e.add_context(fmt::format("door between {} and {} at ({:.2f}, {:.2f})", door.between[0],
                                door.between[1], door.centre.x(), door.centre.y()));
      throw;
    }
  }
  for (const WindowPlan& window : plan.windows) {
    try {
      RoomWalls& room = walls[room_index(plan, window.room)];
      build_window(window, plan.outer_wall, room, builder);
    } catch (Error& e) {
      e.add_context(fmt::format("window of {} at ({:.2f}, {:.2f})", window.room, window.centre.x(),
                                window.centre.y()));
      throw;
    }
  }
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    build_room(plan.rooms[i], walls[i], builder);
    building.rooms.push_back(true_room(plan.rooms[i]));
  }
  for (const Box& box : plan.furniture) builder.add_box("clutter", box.base, box.size, box.turn);
  building.mesh = builder.mesh();
  turn(building);
  return building;
}

}  // namespace planum
