#pragma once

#include <filesystem>

#include "meshing/triangulation.hpp"
#include "tools/maps/labelled_map.hpp"

namespace planum {

/// Writes the map as a world for Gazebo (SDFormat 1.9): PATH with gravity, a sun and the static
/// model "building", which has a link for each label ("floor", "wall" ...; "rest" for what is no
/// polygon) with one visual and one collision ("floor_visual", "floor_collision"), both the mesh
/// LABEL.obj beside PATH; and the model "ground", an unseen plane at the lowest floor. Filled laser
/// shadows are part of their label. Makes the directory of PATH. Throws Error if triangles, labels
/// and polygons do not match, if there are no triangles, or if a file cannot be written.
void write_sdf_world(const std::filesystem::path& path, const TriangulatedMap& mesh,
                     const LabelledMap& map);

}  // namespace planum
