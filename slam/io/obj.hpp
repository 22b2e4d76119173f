#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Reads vertices and faces of a Wavefront .obj file; the group of a face is the name of the last
/// `usemtl` line ("default" before the first). Faces of more than three corners are cut into
/// triangles; indices may be negative (from the end) and carry `/texture/normal`, which is passed
/// over like all other lines. Throws Error `path:line` for bad numbers and indices, and if there is
/// no face.
LabelledMesh read_obj(const std::filesystem::path& path);

/// Where the corners of triangles lie in a picture.
struct TextureCoordinates {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  std::vector<Eigen::Vector2f> places;  ///< u to the right, v up, a picture from 0 to 1
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< of each triangle in `places`, or `none`
};

struct ObjParams {
  std::string material_library = {};  ///< file name for a `mtllib` line; empty: no such line
  TextureCoordinates texture = {};    ///< for all triangles, or empty
};

/// Writes vertices, and triangles in their order with a `usemtl` line wherever the group changes.
/// Vertices come back exactly. Throws Error if a triangle has no group or no texture
/// coordinates where others have them, or if a group's name is not one line of text.
void write_obj(const std::filesystem::path& path, const LabelledMesh& labelled,
               const ObjParams& params = {});

}  // namespace planum
