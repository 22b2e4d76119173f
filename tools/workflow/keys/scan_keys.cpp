#include <optional>
#include <string>

#include "tools/workflow/keys/keys.hpp"

namespace planum {
namespace {

using Optional = std::optional<double>;
using Text = std::string;

}  // namespace

std::vector<Key> scan_keys() {
  return {
      {"scans", "directory", FIELD(Text, scan_directory), {}, {}, "where the scans are"},
      {"scans",
       "format",
       FIELD(Text, scan_format),
       {},
       {"auto", "uos", "slices", "ply", "xyz"},
       "of the scan files"},
      {"scans",
       "poses",
       FIELD(Text, scan_poses),
       {},
       {},
       "auto: .pose files or odometry.tum beside the scans; a .tum or .g2o file; none"},
      {"scans",
       "min_range_m",
       FIELD(double, limits.min_range),
       {0, 1000},
       {},
       "nearer points are dropped: the robot itself"},
      {"scans",
       "max_range_m",
       FIELD(double, limits.max_range),
       {0, 10000},
       {},
       "farther points are dropped, 0: none"},
      {"sensor",
       "first_beam_deg",
       FIELD(Optional, sensor.first_beam),
       {-360, 360},
       {},
       "azimuth of the first beam, counter-clockwise seen from above"},
      {"sensor", "step_deg", FIELD(Optional, sensor.beam_step), {-90, 90}, {}, "between beams"},
      {"sensor",
       "range_min_m",
       FIELD(Optional, sensor.min_range),
       {0, 1000},
       {},
       "shorter ranges are no returns"},
      {"sensor",
       "range_max_m",
       FIELD(Optional, sensor.max_range),
       {0, 10000},
       {},
       "longer ranges are no returns, 0: no limit"},
      {"sensor", "time_inc_s", FIELD(Optional, sensor.beam_interval), {0, 1}, {}, "between beams"},
      {"sensor",
       "mount_x_m",
       FIELD(Optional, sensor.mount_x),
       {-10, 10},
       {},
       "mirror in front of the tilt axis"},
      {"sensor",
       "mount_z_m",
       FIELD(Optional, sensor.mount_z),
       {-10, 10},
       {},
       "mirror above the tilt axis"},
      {"sensor",
       "tilt_offset_deg",
       FIELD(double, sensor.tilt_offset),
       {-180, 180},
       {},
       "added to every tilt"},
  };
}

}  // namespace planum
