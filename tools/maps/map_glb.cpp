#include "tools/maps/map_glb.hpp"

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/glb_document.hpp"
#include "tools/maps/label_colours.hpp"
#include "tools/maps/label_textures.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

void check(const std::filesystem::path& path, const TriangulatedMap& mesh, const LabelledMap& map,
           const std::vector<TextureFrame>& frames) {
  const std::size_t polygons = map.map.polygons.size(), triangles = mesh.mesh.triangles.size();
  if (map.labels.polygons.size() != polygons || mesh.polygon.size() != triangles ||
      mesh.inferred.size() != triangles)
    throw Error(fmt::format(
        "{}: {} polygons with {} labels, {} triangles of which {} are of a "
        "polygon",
        path.string(), polygons, map.labels.polygons.size(), triangles, mesh.polygon.size()));
  if (!frames.empty() && frames.size() != polygons)
    throw Error(fmt::format("{}: {} polygons, {} of them with a texture", path.string(), polygons,
                            frames.size()));
  for (const std::uint32_t polygon : mesh.polygon)
    if (polygon != TriangulatedMap::rest && polygon >= polygons)
      throw Error(
          fmt::format("{}: a triangle is of polygon {} of {}", path.string(), polygon, polygons));
}

Json extras_of(const LabelledMap& map, std::size_t polygon) {
  const PolygonLabel& label = map.labels.polygons[polygon];
  Json extras = {{"label", name(label.label)},
                 {"confidence", std::round(1000 * label.confidence) / 1000},
                 {"area_m2", std::round(1e4 * map.map.polygons[polygon].area) / 1e4}};
  const auto& rooms = map.rooms.room_of_polygon;
  if (polygon < rooms.size() && rooms[polygon] >= 0)
    extras["room"] = map.rooms.rooms[static_cast<std::size_t>(rooms[polygon])].name;
  return extras;
}

/// The material of each label that occurs, as it was seen.
std::map<Label, GlbMaterial> materials_of(const LabelledMap& map, bool is_textured,
                                          GlbDocument& document) {
  std::map<Label, GlbMaterial> result;
  for (const PolygonLabel& polygon : map.labels.polygons) {
    const Label label = polygon.label;
    if (result.contains(label)) continue;
    GlbMaterial material = {.name = name(label)};
    if (is_textured)
      material.texture = document.add_texture(name(label), texture_png(label));
    else
      material.colour = colour_of(label);
    result.emplace(label, material);
  }
  return result;
}

}  // namespace

void write_map_glb(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map, const std::vector<TextureFrame>& frames) {
  check(path, mesh, map, frames);
  if (mesh.polygon.empty()) throw Error(path.string() + ": there is no triangle for it");
  const std::size_t polygons = map.map.polygons.size();
  std::vector<GlbDocument::Triangles> seen(polygons), inferred(polygons);
  GlbDocument::Triangles rest;
  for (std::size_t i = 0; i < mesh.polygon.size(); ++i) {
    const std::uint32_t polygon = mesh.polygon[i];
    (polygon == TriangulatedMap::rest ? rest
     : mesh.inferred[i]               ? inferred[polygon]
                                      : seen[polygon])
        .push_back(mesh.mesh.triangles[i]);
  }
  GlbDocument document(mesh.mesh.vertices);
  const auto materials = materials_of(map, !frames.empty(), document);
  const auto frame_of = [&](std::size_t p) { return frames.empty() ? TextureFrame{} : frames[p]; };
  for (std::size_t p = 0; p < polygons; ++p) {
    const Label label = map.labels.polygons[p].label;
    document.add(fmt::format("{} {}", name(label), p), seen[p], materials.at(label), frame_of(p),
                 extras_of(map, p));
  }
  for (std::size_t p = 0; p < polygons; ++p) {
    const Label label = map.labels.polygons[p].label;
    GlbMaterial material = materials.at(label);
    material.name += ", inferred";
    material.is_half_transparent = true;
    document.add(fmt::format("{} {}, inferred", name(label), p), inferred[p], material, frame_of(p),
                 {{"label", name(label)}, {"inferred", true}});
  }
  document.add("rest", rest, {.name = "rest", .colour = colour_of_rest()}, {}, {{"label", "rest"}});
  write_file_atomically(path, document.written());
}

}  // namespace planum
