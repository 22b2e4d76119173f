#pragma once

#include <optional>
#include <string>

#include "meshing/normals.hpp"
#include "meshing/surface.hpp"
#include "slam/registration/icp.hpp"
#include "slam/registration/matching_scan.hpp"
#include "slam/registration/sequence.hpp"
#include "slam/sensor/range_limits.hpp"

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

/// Every value of a project file, in the units of the program (m, rad, s). Where a module has a
/// parameter struct, that is what is kept here: its defaults are the defaults of the file.
struct Settings {
  std::string scan_directory;
  std::string scan_format = "auto";
  std::string scan_poses = "auto";
  RangeLimits limits;
  SensorSettings sensor;

  std::string registration_method = "icp";
  std::string pairing = "point-to-plane";
  MatchingScanParams matching;
  IcpParams icp;
  SequenceParams sequence;

  NormalParams normals;
  bool level = true;
  SurfaceParams surface;

  std::string truth;  ///< path, empty: none
  std::string output_directory = "out";
};

}  // namespace planum
