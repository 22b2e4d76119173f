#include "tools/maps/sdf_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/label_colours.hpp"

namespace planum {
namespace {

namespace fs = std::filesystem;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// What becomes a link of the building.
struct Part {
  std::string name;
  Colour colour;
  Triangles triangles;
};

void check(const fs::path& path, const TriangulatedMap& mesh, const LabelledMap& map) {
  const std::size_t polygons = map.map.polygons.size(), triangles = mesh.mesh.triangles.size();
  if (map.labels.polygons.size() != polygons || mesh.polygon.size() != triangles)
    throw Error(fmt::format(
        "{}: {} polygons with {} labels, {} triangles of which {} are of a polygon", path.string(),
        polygons, map.labels.polygons.size(), triangles, mesh.polygon.size()));
  for (const std::uint32_t polygon : mesh.polygon)
    if (polygon != TriangulatedMap::rest && polygon >= polygons)
      throw Error(
          fmt::format("{}: a triangle is of polygon {} of {}", path.string(), polygon, polygons));
  for (const Eigen::Vector3f& v : mesh.mesh.vertices)
    if (!v.allFinite()) throw Error(path.string() + ": a vertex is not finite");
}

Eigen::Vector3f normal_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector3d p = mesh.vertices[a].cast<double>();
  const Eigen::Vector3d normal =
      (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p);
  return normal.normalized().cast<float>();
}

/// One part for each label that has triangles, those without area left out: engines stumble over
/// them.
std::vector<Part> parts_of(const TriangulatedMap& mesh, const LabelledMap& map) {
  std::vector<Part> parts;
  for (const Label label : all_labels) parts.push_back({name(label), colour_of(label), {}});
  parts.push_back({"rest", colour_of_rest(), {}});
  for (std::size_t i = 0; i < mesh.polygon.size(); ++i) {
    if (normal_of(mesh.mesh, mesh.mesh.triangles[i]).isZero()) continue;
    const std::uint32_t polygon = mesh.polygon[i];
    const auto part = polygon == TriangulatedMap::rest
                          ? all_labels.size()
                          : static_cast<std::size_t>(std::find(all_labels.begin(), all_labels.end(),
                                                               map.labels.polygons[polygon].label) -
                                                     all_labels.begin());
    parts[part].triangles.push_back(mesh.mesh.triangles[i]);
  }
  std::erase_if(parts, [](const Part& part) { return part.triangles.empty(); });
  return parts;
}

/// An OBJ file of a part: with normals of its triangles, so that edges stay sharp.
std::string obj_of(const TriangleMesh& mesh, const Part& part) {
  std::map<std::uint32_t, std::size_t> vertices;
  std::map<std::array<long, 3>, std::size_t> normals;
  std::string vertex_lines, normal_lines, face_lines;
  for (const auto& triangle : part.triangles) {
    const Eigen::Vector3f n = normal_of(mesh, triangle);
    const auto [normal, is_new_normal] = normals.try_emplace(
        {std::lround(1e4F * n.x()), std::lround(1e4F * n.y()), std::lround(1e4F * n.z())},
        normals.size() + 1);
    if (is_new_normal)
      normal_lines += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", n.x(), n.y(), n.z());
    face_lines += "f";
    for (const std::uint32_t v : triangle) {
      const auto [vertex, is_new] = vertices.try_emplace(v, vertices.size() + 1);
      const Eigen::Vector3f& p = mesh.vertices[v];
      if (is_new) vertex_lines += fmt::format("v {:.5f} {:.5f} {:.5f}\n", p.x(), p.y(), p.z());
      face_lines += fmt::format(" {}//{}", vertex->second, normal->second);
    }
    face_lines += "\n";
  }
  return fmt::format("# planum: {}, in metres, z is up\no {}\n", part.name, part.name) +
         vertex_lines + normal_lines + face_lines;
}

std::string link_of(const Part& part) {
  const auto channel = [&](std::size_t i) { return part.colour[i] / 255.0; };
  const std::string colour =
      fmt::format("{:.3f} {:.3f} {:.3f} 1", channel(0), channel(1), channel(2));
  const std::string geometry =
      fmt::format("<geometry><mesh><uri>{}.obj</uri></mesh></geometry>", part.name);
  return fmt::format(
      "      <link name=\"{0}\">\n"
      "        <visual name=\"{0}_visual\">\n"
      "          {1}\n"
      "          <material><ambient>{2}</ambient><diffuse>{2}</diffuse></material>\n"
      "        </visual>\n"
      "        <collision name=\"{0}_collision\">\n"
      "          {1}\n"
      "        </collision>\n"
      "      </link>\n",
      part.name, geometry, colour);
}

/// m, of the lowest vertex of a floor; without a floor, of all.
double ground_height(const TriangulatedMap& mesh, const LabelledMap& map) {
  double lowest_floor = HUGE_VAL, lowest = HUGE_VAL;
  for (std::size_t i = 0; i < map.map.polygons.size(); ++i)
    if (map.labels.polygons[i].label == Label::floor)
      for (const std::uint32_t v : map.map.polygons[i].outer)
        lowest_floor = std::min(lowest_floor, map.map.vertices[v].z());
  for (const Eigen::Vector3f& v : mesh.mesh.vertices) lowest = std::min(lowest, double(v.z()));
  return lowest_floor < HUGE_VAL ? lowest_floor : lowest;
}

std::string world_of(const std::vector<Part>& parts, double ground) {
  std::string links;
  for (const Part& part : parts) links += link_of(part);
  return fmt::format(
      R"(<?xml version="1.0"?>
<sdf version="1.9">
  <world name="building">
    <gravity>0 0 -9.8</gravity>
    <scene>
      <ambient>0.6 0.6 0.6 1</ambient>
      <background>0.8 0.8 0.8 1</background>
      <shadows>false</shadows>
    </scene>
    <light name="sun" type="directional">
      <pose>0 0 {0:.3f} 0 0 0</pose>
      <cast_shadows>false</cast_shadows>
      <diffuse>0.8 0.8 0.8 1</diffuse>
      <specular>0.1 0.1 0.1 1</specular>
      <direction>-0.4 0.3 -0.87</direction>
    </light>
    <model name="ground">
      <static>true</static>
      <pose>0 0 {1:.3f} 0 0 0</pose>
      <link name="ground">
        <collision name="ground_collision">
          <geometry><plane><normal>0 0 1</normal><size>1000 1000</size></plane></geometry>
        </collision>
      </link>
    </model>
    <model name="building">
      <static>true</static>
{2}    </model>
  </world>
</sdf>
)",
      ground + 100, ground, links);
}

}  // namespace

void write_sdf_world(const fs::path& path, const TriangulatedMap& mesh, const LabelledMap& map) {
  check(path, mesh, map);
  const std::vector<Part> parts = parts_of(mesh, map);
  if (parts.empty()) throw Error(path.string() + ": there is no triangle for it");
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  if (failure)
    throw Error(path.parent_path().string() + ": cannot make the directory: " + failure.message(),
                ErrorKind::environment);
  for (const Part& part : parts)
    write_file_atomically(path.parent_path() / (part.name + ".obj"), obj_of(mesh.mesh, part));
  write_file_atomically(path, world_of(parts, ground_height(mesh, map)));
}

}  // namespace planum
