#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/ply.hpp"
#include "slam/io/ply_rows.hpp"
#include "slam/io/polygon_ears.hpp"

namespace planum {
namespace {

/// Adds three columns of vectors if the element has all of them; makes room in `vectors`.
bool request_vectors(const PlyElement& element, const std::array<const char*, 3>& names,
                     std::vector<Eigen::Vector3f>& vectors, PlyRequest& request) {
  std::array<std::size_t, 3> positions;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto position = element.property(names[i]);
    if (!position || element.properties[*position].count_type) return false;
    positions[i] = *position;
  }
  vectors.resize(element.count);
  for (std::size_t i = 0; i < 3; ++i)
    request.columns.push_back({.property = positions[i],
                               .floats = reinterpret_cast<float*>(vectors.data()) + i,
                               .indices = nullptr,
                               .stride = 3});
  return true;
}

void request_points(const PlyElement& element, const std::filesystem::path& path,
                    std::vector<Eigen::Vector3f>& points, PlyRequest& request) {
  if (!request_vectors(element, {"x", "y", "z"}, points, request))
    throw Error(path.string() + ": its vertices have no properties x, y and z");
}

/// The position of a scalar property.
std::optional<std::size_t> scalar(const PlyElement& element, std::string_view name) {
  const auto position = element.property(name);
  if (position && element.properties[*position].count_type) return std::nullopt;
  return position;
}

void request_attributes(const PlyElement& element, Cloud& cloud, PlyRequest& request) {
  request_vectors(element, {"nx", "ny", "nz"}, cloud.normals, request);
  auto intensity = scalar(element, "intensity");
  if (!intensity) intensity = scalar(element, "scalar_intensity");
  if (intensity) {
    cloud.intensity.resize(element.count);
    request.columns.push_back(
        {.property = *intensity, .floats = cloud.intensity.data(), .indices = nullptr});
  }
  if (const auto scan = scalar(element, "scan")) {
    cloud.scan.resize(element.count);
    request.columns.push_back({.property = *scan, .floats = nullptr, .indices = cloud.scan.data()});
  }
}

/// The corners of all faces, one face behind the other.
struct Faces {
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> sizes;
};

void request_faces(const PlyElement& element, const std::filesystem::path& path, Faces& faces,
                   PlyRequest& request) {
  auto list = element.property("vertex_indices");
  if (!list) list = element.property("vertex_index");
  if (!list || !element.properties[*list].count_type)
    throw Error(path.string() + ": its faces have no list vertex_indices");
  faces.corners.reserve(3 * element.count);
  faces.sizes.reserve(element.count);
  request.list_property = *list;
  request.list = [&faces](std::span<const std::uint32_t> face) {
    faces.corners.insert(faces.corners.end(), face.begin(), face.end());
    faces.sizes.push_back(static_cast<std::uint32_t>(face.size()));
  };
}

void add_triangles(const Faces& faces, const std::filesystem::path& path, TriangleMesh& mesh) {
  mesh.triangles.reserve(faces.sizes.size());
  std::span<const std::uint32_t> rest = faces.corners;
  for (std::size_t f = 0; f < faces.sizes.size(); ++f) {
    const auto face = rest.first(faces.sizes[f]);
    rest = rest.subspan(face.size());
    if (face.size() < 3)
      throw Error(fmt::format("{}: face {} has {} corners", path.string(), f, face.size()));
    for (const std::uint32_t corner : face)
      if (corner >= mesh.vertices.size())
        throw Error(fmt::format("{}: face {} has the corner {}, but there are {} vertices",
                                path.string(), f, corner, mesh.vertices.size()));
    if (face.size() == 3) {
      mesh.triangles.push_back({face[0], face[1], face[2]});
    } else {
      const auto triangles = triangulated_polygon(mesh.vertices, face);
      mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    }
  }
}

}  // namespace

Cloud read_ply_cloud(const std::filesystem::path& path) {
  const PlyHeader header = read_ply_header(path);
  const auto rows = open_ply_rows(path, header);
  Cloud cloud;
  for (const PlyElement& element : header.elements) {
    PlyRequest request;
    if (element.name != "vertex") {
      rows->read(element, request);
      continue;
    }
    rows->check_size(element);
    request_points(element, path, cloud.points, request);
    request_attributes(element, cloud, request);
    rows->read(element, request);
    return cloud;
  }
  throw Error(path.string() + ": there is no element vertex in it");
}

TriangleMesh read_ply_mesh(const std::filesystem::path& path) {
  const PlyHeader header = read_ply_header(path);
  const auto rows = open_ply_rows(path, header);
  TriangleMesh mesh;
  Faces faces;
  bool has_vertices = false, has_faces = false;
  for (const PlyElement& element : header.elements) {
    PlyRequest request;
    rows->check_size(element);
    if (element.name == "vertex" && !has_vertices) {
      request_points(element, path, mesh.vertices, request);
      has_vertices = true;
    } else if (element.name == "face" && !has_faces) {
      request_faces(element, path, faces, request);
      has_faces = true;
    }
    rows->read(element, request);
  }
  if (!has_vertices) throw Error(path.string() + ": there is no element vertex in it");
  if (!has_faces) throw Error(path.string() + ": there is no element face in it");
  add_triangles(faces, path, mesh);
  return mesh;
}

}  // namespace planum
