#pragma once

#include <filesystem>

#include "meshing/triangulation.hpp"
#include "tools/maps/labelled_map.hpp"

namespace planum {

struct NavmeshParams {
  double cell = 0.05;          ///< m, of the grid that the mesh is made from
  double cell_height = 0.025;  ///< m
  double robot_radius = 0.25;  ///< m, it keeps so far from walls
  double robot_height = 1.5;   ///< m, it fits under what is higher
  double robot_climb = 0.1;    ///< m, it drives over what is lower
};

/// Writes where a robot can drive, as a tiled mesh of Detour (docs/formats-results.md): floors and
/// stairs as far as nothing stands there. Doors, passages and thresholds nobody saw the floor of
/// are taken for level. Coordinates are those of Recast: x, z, -y of the world, y is up.
/// Throws Error if labels, polygons and triangles do not match, if there is no floor that the robot
/// can stand on, for parameters out of range, for a map that is too large for Detour, and if the
/// file cannot be written. The same for any number of threads.
void write_navmesh(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map, const NavmeshParams& params = {});

}  // namespace planum
