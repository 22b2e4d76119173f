#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/ply.hpp"

namespace planum {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values are written as they are in memory");
static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));

/// One thing that each row has, as it is in memory.
struct Part {
  const void* values = nullptr;
  std::size_t bytes = 0;  ///< of one row
};

/// Writes rows of parts, many at a time.
void write_rows(AtomicFile& file, std::size_t count, const std::vector<Part>& parts) {
  constexpr std::size_t block_bytes = 1 << 19;
  std::size_t row_bytes = 0;
  for (const Part& part : parts) row_bytes += part.bytes;
  const std::size_t rows_per_block = block_bytes / row_bytes;
  std::vector<char> block(rows_per_block * row_bytes);
  for (std::size_t first = 0; first < count; first += rows_per_block) {
    const std::size_t rows = std::min(rows_per_block, count - first);
    char* column = block.data();
    for (const Part& part : parts) {
      const char* from = static_cast<const char*>(part.values) + first * part.bytes;
      for (std::size_t i = 0; i < rows; ++i)
        std::memcpy(column + i * row_bytes, from + i * part.bytes, part.bytes);
      column += part.bytes;
    }
    file.write(std::string_view(block.data(), rows * row_bytes));
  }
}

/// Adds a list to the rows of an element and its properties to the header, unless it is empty.
template <class Value>
void add_part(const std::vector<Value>& values, std::size_t count, const std::string& properties,
              std::vector<Part>& parts, std::string& header) {
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
  std::vector<Part> parts = {{cloud.points.data(), sizeof(Eigen::Vector3f)}};
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
  std::vector<Part> vertex_parts = {{mesh.vertices.data(), sizeof(Eigen::Vector3f)}};
  add_part(attributes.vertex_colours, vertices, colour_properties, vertex_parts, header);
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", triangles);
  const std::vector<std::uint8_t> corner_counts(triangles, 3);
  std::vector<Part> face_parts = {{corner_counts.data(), 1},
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
