#include <string>

#include "tools/workflow/keys/keys.hpp"

namespace planum {
namespace {

using Text = std::string;

}  // namespace

std::vector<Key> map_keys() {
  return {
      {"maps",
       "textures",
       FIELD(bool, maps.textures),
       {},
       {},
       "map.obj and map.glb have pictures; else the colours of the labels"},
      {"maps", "glb", FIELD(bool, maps.glb), {}, {}, "write map.glb, for viewers"},
      {"maps", "pcd", FIELD(bool, maps.pcd), {}, {}, "write cloud.pcd, for PCL"},
      {"maps", "floor_plan", FIELD(bool, maps.floor_plan), {}, {}, "write floorplan.svg"},
      {"maps", "dxf", FIELD(bool, maps.dxf), {}, {}, "write floorplan.dxf, for CAD programs"},
      {"maps", "cityjson", FIELD(bool, maps.cityjson), {}, {}, "write map.city.json, CityJSON 2.0"},
      {"maps",
       "occupancy",
       FIELD(bool, maps.occupancy),
       {},
       {},
       "write occupancy.yaml and .pgm, for map_server"},
      {"maps",
       "occupancy_cell_m",
       FIELD(double, occupancy.cell),
       {0.01, 1},
       {},
       "of the occupancy map"},
      {"maps",
       "robot_low_m",
       FIELD(double, occupancy.low),
       {0, 10},
       {},
       "above the floor: what is lower the robot drives over"},
      {"maps",
       "robot_high_m",
       FIELD(double, occupancy.high),
       {0.01, 100},
       {},
       "above the floor: what is higher it drives under"},
      {"maps",
       "robot_radius_m",
       FIELD(double, navmesh.robot_radius),
       {0.01, 10},
       {},
       "navmesh.bin keeps so far from walls"},
      {"maps",
       "octomap",
       FIELD(bool, maps.octomap),
       {},
       {},
       "write map.bt and map.ot, for OctoMap"},
      {"maps",
       "octomap_cell_m",
       FIELD(double, octomap.cell),
       {0.01, 1},
       {},
       "of map.bt and map.ot"},
      {"maps", "navmesh", FIELD(bool, maps.navmesh), {}, {}, "write navmesh.bin, for Detour"},
      {"maps",
       "objects",
       FIELD(bool, maps.objects),
       {},
       {},
       "write objects.obj, the models of objects in their places"},
      {"maps", "sdf", FIELD(bool, maps.sdf), {}, {}, "write world/, for Gazebo"},
      {"evaluation",
       "truth",
       FIELD(Text, truth),
       {},
       {},
       "a .tum file: every run reports its error against it"},
      {"output", "directory", FIELD(Text, output_directory), {}, {}, "of all results"},
  };
}

}  // namespace planum
