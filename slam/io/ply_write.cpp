#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/binary_rows.hpp"
#include "slam/io/ply.hpp"

namespace planum {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

/// Adds a list to the rows of an element and its properties to the header, unless it is empty.
template <class Value>
void add_part(const std::vector<Value>& values, std::size_t count, const std::string& properties,
              std::vector<RowPart>& parts, std::string& header) {
  if (values.empty()) return;
  if (values.size() != count)
    throw Error(fmt::format("PLY: {} values for {} rows of \"{}\"", values.size(), count,
                            properties.substr(0, properties.find('\n'))));
  parts.push_back({values.data(), sizeof(Value)});
  header += properties;
}

constexpr const char* point_properties = "property float x\nproperty float y\nproperty float z\n";
constexpr const char* colour_properties =
    "property uchar red\nproperty uchar green\nproperty uchar blue\n";

std::string file_start() { return "ply\nformat binary_little_endian 1.0\n"; }

}  // namespace

void write_ply(const std::filesystem::path& path, const Cloud& cloud) {
  const std::size_t count = cloud.points.size();
  std::string header = file_start() + fmt::format("element vertex {}\n", count) + point_properties;
  std::vector<RowPart> parts = {{cloud.points.data(), sizeof(Eigen::Vector3f)}};
  add_part(cloud.normals, count, "property float nx\nproperty float ny\nproperty float nz\n", parts,
           header);
  add_part(cloud.intensity, count, "property float intensity\n", parts, header);
  add_part(cloud.scan, count, "property uint scan\n", parts, header);
  AtomicFile file(path);
  file.write(header + "end_header\n");
  write_rows(file, count, parts);
  file.commit();
}

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh,
               const MeshAttributes& attributes) {
  const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  std::string header =
      file_start() + fmt::format("element vertex {}\n", vertices) + point_properties;
  std::vector<RowPart> vertex_parts = {{mesh.vertices.data(), sizeof(Eigen::Vector3f)}};
  add_part(attributes.vertex_colours, vertices, colour_properties, vertex_parts, header);
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", triangles);
  const std::vector<std::uint8_t> corner_counts(triangles, 3);
  std::vector<RowPart> face_parts = {{corner_counts.data(), 1},
                                     {mesh.triangles.data(), sizeof(std::array<std::uint32_t, 3>)}};
  add_part(attributes.triangle_colours, triangles, colour_properties, face_parts, header);
  for (const FaceProperty& property : attributes.triangle_properties)
    add_part(property.values, triangles, fmt::format("property int {}\n", property.name),
             face_parts, header);
  AtomicFile file(path);
  file.write(header + "end_header\n");
  write_rows(file, vertices, vertex_parts);
  write_rows(file, triangles, face_parts);
  file.commit();
}

}  // namespace planum
