#pragma once

#include <filesystem>
#include <vector>

#include "meshing/triangulation.hpp"
#include "tools/maps/labelled_map.hpp"
#include "tools/maps/texture_frames.hpp"

namespace planum {

/// Writes the map as triangles: label colours, and for each triangle `label` (the number of the
/// label, -1 for what is no polygon), `polygon` (its id, or -1) and `inferred` (1: a laser shadow
/// that was filled).
void write_map_ply(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const Labels& labels);

/// Writes PATH and, beside it, the same name with .mtl: one material a label ("floor", "wall" ...;
/// "rest" for what is no polygon). With a frame for each polygon (texture_frames) the materials
/// have pictures, textures/LABEL.png beside PATH; without, the colours of the labels.
void write_map_obj(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const Labels& labels, const std::vector<TextureFrame>& frames = {});

}  // namespace planum
