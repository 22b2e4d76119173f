#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Reads the vertices of a PLY file (ascii, binary of either byte order) as points: x y z, and nx
/// ny nz, intensity (or scalar_intensity), scan where they are there, of any scalar type. Other
/// properties and elements are passed over. Throws Error for a bad header, a file that is shorter
/// than its header says, and a scan that is no index.
Cloud read_ply_cloud(const std::filesystem::path& path);

/// Writes points with the attributes they have: binary, little endian, float x y z nx ny nz
/// intensity, uint scan. Throws Error if an attribute is neither empty nor as long as the points.
void write_ply(const std::filesystem::path& path, const Cloud& cloud);

/// Reads vertices and faces; faces of more than three corners are cut into triangles. Throws Error
/// like read_ply_cloud, for a face with fewer corners or with one that does not exist, and if the
/// file has no element `face`.
TriangleMesh read_ply_mesh(const std::filesystem::path& path);

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// A whole number for each triangle, e.g. the polygon it is from.
struct FaceProperty {
  std::string name;
  std::vector<std::int32_t> values;
};

/// What a mesh file may carry beside the mesh; lists are empty or one entry a vertex or triangle.
struct MeshAttributes {
  std::vector<Colour> vertex_colours;
  std::vector<Colour> triangle_colours;
  std::vector<FaceProperty> triangle_properties;
};

/// Writes a mesh: binary, little endian, float x y z, uchar red green blue; list uchar int
/// vertex_indices, uchar red green blue, int properties. Throws Error if a list has another length.
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh,
               const MeshAttributes& attributes = {});

}  // namespace planum
