#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "meshing/polygon_map.hpp"
#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"
#include "tools/workflow/labelled.hpp"
#include "tools/workflow/settings.hpp"

namespace planum {

/// All that maps are written from.
struct MapSources {
  const Cloud& cloud;                           ///< `scan`: an index into `origins`
  std::span<const Eigen::Vector3d> origins;     ///< m, where the scans were taken
  std::span<const std::uint32_t> scan_numbers;  ///< of the scans, for people and programs
  const TriangleMesh& mesh;
  const PolygonMap& polygons;
  const Labelled& labelled;
};

struct MapFiles {
  std::vector<std::string> written;   ///< one file of each format
  std::vector<std::string> warnings;  ///< what was wanted and could not be, and why
};

/// Writes polygons.json, map.ply, map.obj and the formats that `settings.maps` wants into `folder`,
/// which exists. What a format cannot take is a warning, and the others are written; only an Error
/// of the environment (a full disk) ends it.
MapFiles write_map_files(const std::filesystem::path& folder, const MapSources& sources,
                         const Settings& settings);

}  // namespace planum
