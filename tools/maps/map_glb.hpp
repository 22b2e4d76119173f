#pragma once

#include <filesystem>
#include <vector>

#include "meshing/triangulation.hpp"
#include "tools/maps/labelled_map.hpp"
#include "tools/maps/texture_frames.hpp"

namespace planum {

/// Writes the map as binary glTF 2.0: a node for each polygon ("wall 3": label and `id` of
/// polygons.json), for the filled laser shadows of one ("wall 3, inferred") and for the rest, under
/// one that turns z up into glTF's y up. `extras` of a node hold `label`, `confidence`, `area_m2`
/// and `room`. With a frame for each polygon (texture_frames) the textures of the labels are in the
/// file; without, surfaces have the colours of their labels. Throws Error if triangles, labels,
/// frames and polygons do not match, if there are no triangles, or if the file cannot be written.
void write_map_glb(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map, const std::vector<TextureFrame>& frames = {});

}  // namespace planum
