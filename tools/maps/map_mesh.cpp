#include "tools/maps/map_mesh.hpp"

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "slam/io/obj.hpp"
#include "slam/io/ply.hpp"
#include "tools/maps/label_colours.hpp"

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
                   const Labels& labels) {
  std::string materials = "# colours of the labels of planum, Okabe & Ito's palette\n";
  LabelledMesh labelled;
  labelled.mesh = mesh.mesh;
  for (const Label label : all_labels) {
    labelled.names.emplace_back(name(label));
    materials += material_text(name(label), colour_of(label));
  }
  labelled.names.emplace_back("rest");
  materials += material_text("rest", colour_of_rest());
  for (const PolygonLabel* label : labels_of_triangles(mesh, labels))
    labelled.group.push_back(label ? static_cast<std::uint32_t>(label->label)
                                   : static_cast<std::uint32_t>(all_labels.size()));
  std::filesystem::path library = path;
  library.replace_extension(".mtl");
  write_file_atomically(library, materials);
  write_obj(path, labelled, {.material_library = library.filename().string()});
}

}  // namespace planum
