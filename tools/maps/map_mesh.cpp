#include "tools/maps/map_mesh.hpp"

#include <array>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "tools/maps/label_colours.hpp"
#include "tools/maps/label_textures.hpp"

namespace planum {
namespace {

/// The label of each triangle, or null where it is in no polygon.
std::vector<const PolygonLabel*> labels_of_triangles(const TriangulatedMap& mesh,
                                                     const Labels& labels) {
  if (mesh.polygon.size() != mesh.mesh.triangles.size())
    throw Error(fmt::format("map: {} triangles, but {} of them are of a polygon",
                            mesh.mesh.triangles.size(), mesh.polygon.size()));
  std::vector<const PolygonLabel*> result;
  for (const std::uint32_t polygon : mesh.polygon) {
    if (polygon != TriangulatedMap::rest && polygon >= labels.polygons.size())
      throw Error(fmt::format("map: triangle {} is of polygon {}, but there are {} labels",
                              result.size(), polygon, labels.polygons.size()));
    result.push_back(polygon == TriangulatedMap::rest ? nullptr : &labels.polygons[polygon]);
  }
  return result;
}

std::string material_text(const std::string& material, const Colour& colour) {
  return fmt::format("newmtl {}\nKa 0 0 0\nKd {:.4f} {:.4f} {:.4f}\nKs 0 0 0\nillum 1\n\n",
                     material, colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
}

std::string material_text(const std::string& material, const std::string& picture) {
  return fmt::format("newmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n\n", material,
                     picture);
}

void make_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directory(directory, error);
  if (error)
    throw Error(
        fmt::format("{}: cannot make the directory: {}", directory.string(), error.message()),
        ErrorKind::environment);
}

/// Writes textures/LABEL.png into a directory. Returns the material for it.
std::string write_texture(const std::filesystem::path& directory, Label label) {
  const std::string picture = fmt::format("textures/{}.png", name(label));
  write_file_atomically(directory / picture, texture_png(label));
  return material_text(name(label), picture);
}

/// Each polygon has texture coordinates of its own.
TextureCoordinates texture_coordinates(const TriangulatedMap& mesh,
                                       const std::vector<TextureFrame>& frames) {
  TextureCoordinates result;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> place_of;  // polygon and vertex
  for (std::size_t i = 0; i < mesh.polygon.size(); ++i) {
    std::array<std::uint32_t, 3>& corners = result.corners.emplace_back();
    corners.fill(TextureCoordinates::none);
    const std::uint32_t polygon = mesh.polygon[i];
    if (polygon == TriangulatedMap::rest) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.mesh.triangles[i][k];
      const auto next = static_cast<std::uint32_t>(result.places.size());
      const auto [found, is_new] = place_of.try_emplace({polygon, vertex}, next);
      if (is_new)
        result.places.push_back(
            frames.at(polygon).at(mesh.mesh.vertices[vertex].cast<double>()).cast<float>());
      corners[k] = found->second;
    }
  }
  return result;
}

}  // namespace

void write_map_ply(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const Labels& labels) {
  MeshAttributes attributes;
  attributes.triangle_properties = {{"label", {}}, {"polygon", {}}, {"inferred", {}}};
  for (const PolygonLabel* label : labels_of_triangles(mesh, labels)) {
    attributes.triangle_colours.push_back(label ? colour_of(label->label) : colour_of_rest());
    attributes.triangle_properties[0].values.push_back(label ? static_cast<int>(label->label) : -1);
  }
  for (const std::uint32_t polygon : mesh.polygon)  // `rest` is -1
    attributes.triangle_properties[1].values.push_back(static_cast<std::int32_t>(polygon));
  attributes.triangle_properties[2].values.assign(mesh.inferred.begin(), mesh.inferred.end());
  write_ply(path, mesh.mesh, attributes);
}

void write_map_obj(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const Labels& labels, const std::vector<TextureFrame>& frames) {
  LabelledMesh labelled;
  labelled.mesh = mesh.mesh;
  for (const Label label : all_labels) labelled.names.emplace_back(name(label));
  labelled.names.emplace_back("rest");
  for (const PolygonLabel* label : labels_of_triangles(mesh, labels))
    labelled.group.push_back(label ? static_cast<std::uint32_t>(label->label)
                                   : static_cast<std::uint32_t>(all_labels.size()));
  ObjParams params;
  std::string materials;
  if (frames.empty()) {
    materials = "# colours of the labels of planum, Okabe & Ito's palette\n";
    for (const Label label : all_labels) materials += material_text(name(label), colour_of(label));
  } else {
    materials = "# textures of the labels of planum, for places in metres\n";
    if (frames.size() != labels.polygons.size())
      throw Error(fmt::format("map: {} polygons have a label, {} have a texture",
                              labels.polygons.size(), frames.size()));
    params.texture = texture_coordinates(mesh, frames);
    make_directory(path.parent_path() / "textures");
    for (const Label label : all_labels) materials += write_texture(path.parent_path(), label);
  }
  materials += material_text("rest", colour_of_rest());
  std::filesystem::path library = path;
  library.replace_extension(".mtl");
  params.material_library = library.filename().string();
  write_file_atomically(library, materials);
  write_obj(path, labelled, params);
}

}  // namespace planum
