#pragma once

#include <optional>
#include <string>

#include "labeling/labels.hpp"
#include "labeling/objects/objects.hpp"
#include "labeling/occupancy.hpp"
#include "labeling/rooms/rooms.hpp"
#include "meshing/free_space.hpp"
#include "meshing/laser_shadows.hpp"
#include "meshing/normals.hpp"
#include "meshing/surface.hpp"
#include "slam/graph/loops.hpp"
#include "slam/graph/relax_lu_milios.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/range_limits.hpp"
#include "tools/maps/navmesh.hpp"
#include "tools/maps/octomap_map.hpp"

namespace planum {

/// [sensor]: values that replace those in the headers of slices files; what is not set stays.
struct SensorSettings {
  std::optional<double> first_beam;     ///< rad
  std::optional<double> beam_step;      ///< rad
  std::optional<double> min_range;      ///< m
  std::optional<double> max_range;      ///< m
  std::optional<double> beam_interval;  ///< s
  std::optional<double> mount_x;        ///< m
  std::optional<double> mount_z;        ///< m
  double tilt_offset = 0;               ///< rad, added to every tilt
};

/// [polygons]: what is not set follows the voxels of the mesh.
struct PolygonSettings {
  std::optional<double> max_angle;     ///< rad
  std::optional<double> max_distance;  ///< m
  std::optional<double> min_area;      ///< m^2
  std::optional<double> max_error;     ///< m
};

/// [maps]: which files are written beside polygons.json, map.ply and map.obj.
struct MapSettings {
  bool textures = true;    ///< of map.obj and map.glb; else the colours of the labels
  bool glb = true;         ///< map.glb
  bool pcd = true;         ///< cloud.pcd
  bool floor_plan = true;  ///< floorplan.svg
  bool dxf = true;         ///< floorplan.dxf
  bool cityjson = true;    ///< the building in CityJSON
  bool occupancy = true;   ///< occupancy.yaml and .pgm
  bool octomap = true;     ///< map.bt and map.ot
  bool sdf = true;         ///< world/, for Gazebo
  bool navmesh = true;     ///< navmesh.bin, for Detour
  bool objects = true;     ///< objects.obj, models in their places
};

/// Every value of a project file, in the units of the program (m, rad, s). Where a module has a
/// parameter struct, that is what is kept here: its defaults are the defaults of the file.
struct Settings {
  std::string scan_directory;
  std::string scan_format = "auto";
  std::string scan_poses = "auto";
  RangeLimits limits;
  SensorSettings sensor;

  std::string registration_method = "icp";
  std::string match_against = "previous";
  std::string pairing = "point-to-plane";
  std::string minimizer = "svd";
  MatchingScanParams matching;
  IcpParams icp;
  SequenceParams sequence;

  bool close_loops = true;
  LoopParams loops;

  std::string relaxation_method = "lu-milios";
  LuMiliosParams relaxation;
  bool refine_planes = true;

  bool level = true;
  NormalParams normals;
  FreeSpaceParams free_space;
  SurfaceParams surface;
  PolygonSettings polygons;
  ShadowParams shadows;
  LabelParams labels;
  ObjectParams objects;
  std::string models;  ///< a directory of models of objects, empty: the built-in ones
  RoomParams rooms;
  MapSettings maps;
  OccupancyParams occupancy;
  OctomapParams octomap;
  NavmeshParams navmesh;  ///< its robot's height and climb are those of `occupancy`

  std::string truth;  ///< path, empty: none
  std::string output_directory = "out";
};

/// The pairing and the minimizer that a project file names.
Pairing pairing_of(const Settings& settings);
Minimizer minimizer_of(const Settings& settings);

}  // namespace planum
