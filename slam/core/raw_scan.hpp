#pragma once

#include <string>
#include <vector>

namespace planum {

/// How a tilting 2D laser measures; the meaning of the header keys of a `.slices` file.
struct TiltedLaser {
  double first_beam =
      -1.5707963267948966;   ///< rad, azimuth of beam 0, counter-clockwise seen from above
  double beam_step = 0;      ///< rad between beams; 0: half a turn over all beams, pi / (beams - 1)
  double min_range = 0;      ///< m, shorter ranges are no returns
  double max_range = 0;      ///< m, longer ranges are no returns; 0: no limit
  double beam_interval = 0;  ///< s between beams; the tilt is interpolated within a slice
  double mount_x = 0;        ///< m, mirror in front of the tilt axis
  double mount_z = 0;        ///< m, mirror above the tilt axis
};

/// One sweep of the 2D laser at one tilt.
struct Slice {
  double time = 0;            ///< s
  double tilt = 0;            ///< rad, positive looks up
  std::vector<float> ranges;  ///< m; 0, negative and non-finite mean no return
};

/// One raw 3D scan: the slices of one nod.
struct RawScan {
  TiltedLaser laser;
  std::vector<Slice> slices;
};

}  // namespace planum
