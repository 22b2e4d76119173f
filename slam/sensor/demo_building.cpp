#include "slam/sensor/demo_building.hpp"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "slam/sensor/furniture.hpp"

namespace planum {
namespace {

PlanPolygon rectangle(double x0, double y0, double x1, double y1) {
  return {.outer = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

PlanPolygon with_hole(PlanPolygon polygon, const PlanPolygon& hole) {
  polygon.holes.push_back(hole.outer);
  return polygon;
}

void add(BuildingPlan& plan, const std::vector<Box>& boxes) {
  plan.furniture.insert(plan.furniture.end(), boxes.begin(), boxes.end());
}

std::vector<RoomPlan> rooms() {
  return {
      {"corridor", with_hole(rectangle(4.05, 3.75, 11.1, 8.4), rectangle(5.55, 5.25, 9.6, 6.9)),
       2.5},
      {"office", rectangle(4.05, 0, 9, 3.6), 2.75},
      {"meeting room", rectangle(9.15, 0, 15, 3.6), 2.95},
      {"laboratory", rectangle(11.25, 3.75, 15, 12), 2.8},
      {"kitchen", rectangle(5.35, 8.55, 11.1, 12), 2.65},
      {"library", rectangle(0, 8.55, 5.2, 12), 2.85},
      // With a pillar.
      {"lounge", with_hole(rectangle(0, 0, 3.9, 8.4), rectangle(1.9, 2.9, 2.25, 3.25)), 3.1},
  };
}

std::vector<DoorPlan> doors() {
  return {
      {{"corridor", "office"}, {4.85, 3.675}, 0.9, 2.05},
      {{"office", "meeting room"}, {9.075, 2.0}, 0.8, 2.0},
      {{"meeting room", "corridor"}, {10.35, 3.675}, 0.9, 2.05},
      {{"corridor", "laboratory"}, {11.175, 4.6}, 1.0, 2.1},
      {{"laboratory", "corridor"}, {11.175, 7.65}, 0.9, 2.0},
      {{"corridor", "kitchen"}, {10.3, 8.475}, 0.9, 2.05},
      {{"kitchen", "library"}, {5.275, 10.2}, 0.85, 2.0},
      {{"library", "corridor"}, {4.62, 8.475}, 0.8, 2.05},
      {{"corridor", "lounge"}, {3.975, 7.55}, 0.9, 2.05},
      {{"lounge", "corridor"}, {3.975, 4.5}, 1.0, 2.1},
  };
}

std::vector<WindowPlan> windows() {
  return {
      {"office", {5.6, 0}, 1.4, 1.3, 0.9},       {"office", {7.9, 0}, 1.4, 1.3, 0.9},
      {"meeting room", {11, 0}, 1.6, 1.4, 0.9},  {"meeting room", {13.3, 0}, 1.6, 1.4, 0.9},
      {"meeting room", {15, 1.8}, 1.4, 1.3, 1},  {"laboratory", {15, 6.9}, 1.5, 1.2, 1.1},
      {"laboratory", {15, 10.6}, 1.5, 1.2, 1.1}, {"kitchen", {10.2, 12}, 1.1, 1.1, 1.1},
      {"kitchen", {7.6, 12}, 1.2, 1.0, 1.1},     {"library", {4.4, 12}, 1.0, 1.4, 0.9},
      {"lounge", {0, 3.4}, 1.6, 1.6, 0.8},       {"lounge", {0, 7.3}, 1.4, 1.6, 0.8},
  };
}

void furnish_south(BuildingPlan& plan) {
  // Office
  add(plan, table({6.7, 0.45}, {1.6, 0.75}));
  add(plan, chair({6.6, 1.0}, radians(-80)));
  add(plan, cabinet({4.3, 0.9}, {0.45, 1.3}, 1.9));
  add(plan, cabinet({6.9, 3.4}, {1.7, 0.38}, 1.2));
  // Meeting room
  add(plan, table({12.8, 1.8}, {2.4, 1.1}, radians(6)));
  add(plan, chair({12.1, 0.85}, radians(90)));
  add(plan, chair({13.4, 0.95}, radians(100)));
  add(plan, chair({12.2, 2.75}, radians(-85)));
  add(plan, chair({13.5, 2.85}, radians(-70)));
  add(plan, cabinet({14.75, 3.0}, {0.45, 1.1}, 0.8));
}

void furnish_east_and_north(BuildingPlan& plan) {
  // Laboratory
  add(plan, table({14.6, 5.4}, {2.2, 0.75}, radians(90)));
  add(plan, chair({13.95, 5.2}, radians(15)));
  add(plan, cabinet({14.75, 8.7}, {0.5, 1.6}, 1.95));
  add(plan, table({13.3, 10.3}, {1.8, 0.9}, radians(17)));
  add(plan, chair({12.2, 10.9}, radians(-30)));
  // Kitchen
  add(plan, cabinet({8.7, 11.7}, {2.8, 0.6}, 0.9));
  add(plan, cabinet({5.75, 11.6}, {0.7, 0.7}, 1.8));
  add(plan, table({7.4, 9.0}, {1.2, 0.75}));
  add(plan, chair({6.55, 9.05}, radians(10)));
  add(plan, chair({8.25, 9.0}, radians(175)));
  // Library
  add(plan, cabinet({0.2, 10.3}, {0.4, 2.4}, 2.1));
  add(plan, cabinet({2.3, 11.8}, {2.2, 0.4}, 2.1));
  add(plan, sofa({1.8, 9.0}, 1.9));
  add(plan, table({2.1, 10.3}, {0.8, 0.6}, radians(25)));
}

void furnish_west(BuildingPlan& plan) {
  // Lounge
  add(plan, sofa({0.45, 5.4}, 2.0, radians(-90)));
  add(plan, table({1.35, 5.5}, {0.9, 0.55}, radians(85)));
  add(plan, cabinet({3.62, 1.7}, {0.55, 2.0}, 0.5));
  add(plan, cabinet({0.65, 0.27}, {1.3, 0.5}, 2.0));
  add(plan, table({2.0, 1.4}, {1.4, 0.8}, radians(20)));
  add(plan, chair({1.0, 1.7}, radians(5)));
  // Corridor
  add(plan, cabinet({7.6, 5.07}, {1.3, 0.32}, 0.85));
}

}  // namespace

BuildingPlan demo_plan() {
  BuildingPlan plan{.name = "demo",
                    .rooms = rooms(),
                    .doors = doors(),
                    .windows = windows(),
                    .turn = radians(12)};
  furnish_south(plan);
  furnish_east_and_north(plan);
  furnish_west(plan);
  return plan;
}

Building demo_building() { return built(demo_plan()); }

std::vector<Pose> demo_poses() {
  struct Stop {
    double x, y, heading;  ///< m, m, degrees in the plan
  };
  constexpr std::array<Stop, 26> stops{{
      {4.7, 4.5, 5},      // corridor
      {4.85, 3.65, -30},  // doorway
      {5.3, 2.2, -5},     // office
      {7.3, 2.0, 5},      //
      {8.6, 2.0, 10},     // before a door
      {9.9, 1.3, 45},     // meeting room
      {10.3, 3.3, 60},    // before a door
      {11.05, 4.6, 60},   // doorway
      {12.6, 5.4, 90},    // laboratory
      {12.9, 7.3, 115},   //
      {11.2, 7.65, 148},  // doorway
      {10.3, 8.45, 155},  // doorway
      {8.9, 10.1, 180},   // kitchen
      {7.0, 10.2, 185},   //
      {5.75, 10.2, 192},  // before a door
      {4.4, 10.0, 228},   // library
      {4.6, 8.85, 245},   // before a door
      {4.1, 7.57, 240},   // doorway
      {2.6, 6.6, 270},    // lounge
      {2.3, 4.6, 290},    //
      {3.95, 4.5, 325},   // doorway
      {4.9, 4.5, 0},      // corridor: the ring is closed
      {6.9, 4.45, 5},     //
      {8.9, 4.5, 15},     //
      {10.3, 4.9, 52},    //
      {10.35, 6.6, 90},   //
  }};
  const Pose building_from_plan(Eigen::AngleAxisd(demo_plan().turn, Eigen::Vector3d::UnitZ()));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    // No floor is perfectly even.
    const double phase = static_cast<double>(i);
    const double pitch = radians(0.6) * std::sin(1.7 * phase);
    const double roll = radians(0.5) * std::cos(2.3 * phase);
    const auto& [x, y, heading] = stops[i];
    poses.push_back(building_from_plan *
                    pose_from_xyz_ypr({x, y, 0.6}, radians(heading), pitch, roll));
  }
  return poses;
}

}  // namespace planum
