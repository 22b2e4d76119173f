#pragma once

#include <filesystem>

#include "meshing/triangulation.hpp"
#include "tools/maps/labelled_map.hpp"

namespace planum {

/// Writes the map as binary glTF 2.0: a node for each polygon ("wall 3": label and `id` of
/// polygons.json), for the filled laser shadows of one ("wall 3, inferred") and for the rest, under
/// one that turns z up into glTF's y up. `extras` of a node hold `label`, `confidence`, `area_m2`
/// and `room`. Throws Error if triangles, labels and polygons do not match, if there are no
/// triangles, or if the file cannot be written.
void write_map_glb(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map);

}  // namespace planum
