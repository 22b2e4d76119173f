#include "tools/maps/map_glb.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "slam/core/error.hpp"
#include "slam/io/atomic_file.hpp"
#include "tools/maps/label_colours.hpp"

namespace planum {
namespace {

using Json = nlohmann::ordered_json;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Numbers of the glTF 2.0 specification.
constexpr int of_floats = 5126, of_indices = 5125;          // types of accessors
constexpr int vertex_buffer = 34962, index_buffer = 34963;  // targets of buffer views

double linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Json material(const std::string& name, const Colour& colour, bool is_inferred) {
  Json result = {
      {"name", is_inferred ? name + ", inferred" : name},
      {"pbrMetallicRoughness",
       {{"baseColorFactor",
         {linear(colour[0]), linear(colour[1]), linear(colour[2]), is_inferred ? 0.5 : 1.0}},
        {"metallicFactor", 0},
        {"roughnessFactor", 1}}}};
  if (is_inferred) result["alphaMode"] = "BLEND";
  return result;
}

/// Collects pieces of the map as nodes; each has vertices of its own.
class Document {
 public:
  explicit Document(const std::vector<Eigen::Vector3f>& vertices)
      : vertices_(vertices), name_(vertices.size(), unnamed) {
    // The world's z up becomes y up.
    nodes_.push_back({{"name", "map"},
                      {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                      {"children", Json::array()}});
  }

  void add(const std::string& name, const Triangles& triangles, const std::string& label,
           const Colour& colour, bool is_inferred, Json extras) {
    if (triangles.empty()) return;
    const auto [positions, indices] = add_geometry(triangles);
    meshes_.push_back(
        {{"name", name},
         {"primitives", Json::array({{{"attributes", {{"POSITION", positions}}},
                                      {"indices", indices},
                                      {"material", material_of(label, colour, is_inferred)}}})}});
    nodes_.front()["children"].push_back(nodes_.size());
    nodes_.push_back({{"name", name}, {"mesh", meshes_.size() - 1}, {"extras", std::move(extras)}});
  }

  bool is_empty() const { return meshes_.empty(); }

  /// The whole file.
  std::string written() const {
    const std::size_t bytes = 4 * (positions_.size() + indices_.size());
    const Json json = {{"asset", {{"version", "2.0"}, {"generator", "planum"}}},
                       {"scene", 0},
                       {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
                       {"nodes", nodes_},
                       {"meshes", meshes_},
                       {"materials", materials_},
                       {"accessors", accessors_},
                       {"bufferViews", Json::array({{{"buffer", 0},
                                                     {"byteOffset", 0},
                                                     {"byteLength", 4 * positions_.size()},
                                                     {"byteStride", 12},
                                                     {"target", vertex_buffer}},
                                                    {{"buffer", 0},
                                                     {"byteOffset", 4 * positions_.size()},
                                                     {"byteLength", 4 * indices_.size()},
                                                     {"target", index_buffer}}})},
                       {"buffers", Json::array({{{"byteLength", bytes}}})}};
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file;
    append(file, {0x46546C67, 2, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes)});
    append(file, {static_cast<std::uint32_t>(text.size()), 0x4E4F534A});
    file += text;
    append(file, {static_cast<std::uint32_t>(bytes), 0x004E4942});
    file.append(reinterpret_cast<const char*>(positions_.data()), 4 * positions_.size());
    file.append(reinterpret_cast<const char*>(indices_.data()), 4 * indices_.size());
    return file;
  }

 private:
  static constexpr std::uint32_t unnamed = std::numeric_limits<std::uint32_t>::max();

  static void append(std::string& file, std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t n : numbers) file.append(reinterpret_cast<const char*>(&n), 4);
  }

  /// Returns the accessors of positions and indices.
  std::pair<std::size_t, std::size_t> add_geometry(const Triangles& triangles) {
    const std::size_t first_position = positions_.size(), first_index = indices_.size();
    std::vector<std::uint32_t> used;
    Eigen::Array3f low = Eigen::Array3f::Constant(HUGE_VALF), high = -low;
    for (const auto& t : triangles)
      for (const std::uint32_t v : t) {
        if (name_[v] == unnamed) {
          name_[v] = static_cast<std::uint32_t>(used.size());
          used.push_back(v);
          const Eigen::Vector3f& p = vertices_[v];
          positions_.insert(positions_.end(), {p.x(), p.y(), p.z()});
          low = low.min(p.array());
          high = high.max(p.array());
        }
        indices_.push_back(name_[v]);
      }
    for (const std::uint32_t v : used) name_[v] = unnamed;
    accessors_.push_back({{"bufferView", 0},
                          {"byteOffset", 4 * first_position},
                          {"componentType", of_floats},
                          {"count", used.size()},
                          {"type", "VEC3"},
                          {"min", {low.x(), low.y(), low.z()}},
                          {"max", {high.x(), high.y(), high.z()}}});
    accessors_.push_back({{"bufferView", 1},
                          {"byteOffset", 4 * first_index},
                          {"componentType", of_indices},
                          {"count", indices_.size() - first_index},
                          {"type", "SCALAR"}});
    return {accessors_.size() - 2, accessors_.size() - 1};
  }

  std::size_t material_of(const std::string& label, const Colour& colour, bool is_inferred) {
    Json wanted = material(label, colour, is_inferred);
    for (std::size_t i = 0; i < materials_.size(); ++i)
      if (materials_[i] == wanted) return i;
    materials_.push_back(std::move(wanted));
    return materials_.size() - 1;
  }

  const std::vector<Eigen::Vector3f>& vertices_;
  std::vector<std::uint32_t> name_;  ///< of a vertex in the piece at hand
  std::vector<float> positions_;
  std::vector<std::uint32_t> indices_;
  Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array(),
       accessors_ = Json::array();
};

void check(const std::filesystem::path& path, const TriangulatedMap& mesh, const LabelledMap& map) {
  const std::size_t polygons = map.map.polygons.size(), triangles = mesh.mesh.triangles.size();
  if (map.labels.polygons.size() != polygons || mesh.polygon.size() != triangles ||
      mesh.inferred.size() != triangles)
    throw Error(fmt::format(
        "{}: {} polygons with {} labels, {} triangles of which {} are of a "
        "polygon",
        path.string(), polygons, map.labels.polygons.size(), triangles, mesh.polygon.size()));
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

}  // namespace

void write_map_glb(const std::filesystem::path& path, const TriangulatedMap& mesh,
                   const LabelledMap& map) {
  check(path, mesh, map);
  const std::size_t polygons = map.map.polygons.size();
  std::vector<Triangles> seen(polygons), inferred(polygons);
  Triangles rest;
  for (std::size_t i = 0; i < mesh.polygon.size(); ++i) {
    const std::uint32_t polygon = mesh.polygon[i];
    (polygon == TriangulatedMap::rest ? rest
     : mesh.inferred[i]               ? inferred[polygon]
                                      : seen[polygon])
        .push_back(mesh.mesh.triangles[i]);
  }
  Document document(mesh.mesh.vertices);
  for (std::size_t p = 0; p < polygons; ++p) {
    const Label label = map.labels.polygons[p].label;
    document.add(fmt::format("{} {}", name(label), p), seen[p], name(label), colour_of(label),
                 false, extras_of(map, p));
  }
  for (std::size_t p = 0; p < polygons; ++p) {
    const Label label = map.labels.polygons[p].label;
    document.add(fmt::format("{} {}, inferred", name(label), p), inferred[p], name(label),
                 colour_of(label), true, {{"label", name(label)}, {"inferred", true}});
  }
  document.add("rest", rest, "rest", colour_of_rest(), false, {{"label", "rest"}});
  if (document.is_empty()) throw Error(path.string() + ": there is no triangle for it");
  write_file_atomically(path, document.written());
}

}  // namespace planum
