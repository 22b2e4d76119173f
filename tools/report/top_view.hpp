#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "labeling/rooms/rooms.hpp"
#include "slam/core/cloud.hpp"

namespace planum {

/// What a picture from above shows, in the levelled world. All parts but the cloud may be empty.
struct TopView {
  const Cloud& cloud;               ///< with normals; floors and ceilings are left out
  std::vector<Pose> before, after;  ///< world_from_scan by odometry, and as found
  std::vector<std::string> names;   ///< of the scans, short
  std::vector<std::pair<std::size_t, std::size_t>> loops;  ///< accepted, positions in `after`
  const RoomMap* rooms = nullptr;
};

struct TopViewParams {
  int longest_side = 1600;  ///< pixels, at least 100
  double margin = 0.4;      ///< m around everything, more than 0
};

/// Draws the plan of a map: walls as dense points, rooms with names and sizes, doors and windows,
/// the path before and after, loops, a scale. Writes a PNG. Throws Error if the cloud has no
/// normals, for parameters out of range, or if the file cannot be written.
void write_top_view(const std::filesystem::path& path, const TopView& view,
                    const TopViewParams& params = {});

}  // namespace planum
