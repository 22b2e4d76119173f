#include "tools/maps/glb_document.hpp"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace planum {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int of_floats = 5126, of_indices = 5125;          // types of accessors
constexpr int vertex_buffer = 34962, index_buffer = 34963;  // targets of buffer views
constexpr int linear_filter = 9729, mipmap_filter = 9987, repeated = 10497;  // of samplers

// Views of the buffer; those of pictures follow.
enum View : std::size_t { of_positions, of_triangles, of_texture_coordinates };

constexpr std::uint32_t unnamed = std::numeric_limits<std::uint32_t>::max();

double linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Json material_json(const GlbMaterial& material) {
  const Colour& colour = material.colour;
  Json surface = {{"baseColorFactor",
                   {linear(colour[0]), linear(colour[1]), linear(colour[2]),
                    material.is_half_transparent ? 0.5 : 1.0}},
                  {"metallicFactor", 0},
                  {"roughnessFactor", 1}};
  if (material.texture) surface["baseColorTexture"] = {{"index", *material.texture}};
  Json result = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
  if (material.is_half_transparent) result["alphaMode"] = "BLEND";
  return result;
}

void append(std::string& bytes, std::initializer_list<std::uint32_t> numbers) {
  for (const std::uint32_t n : numbers) bytes.append(reinterpret_cast<const char*>(&n), 4);
}

/// The binary part and the list of its views.
struct Buffer {
  std::string bytes;
  Json views = Json::array();

  template <typename Number>
  void add(const std::vector<Number>& numbers, int target, std::size_t stride = 0) {
    views.push_back({{"buffer", 0},
                     {"byteOffset", bytes.size()},
                     {"byteLength", 4 * numbers.size()},
                     {"target", target}});
    if (stride > 0) views.back()["byteStride"] = stride;
    bytes.append(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
  }

  void add(const std::string& file) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", file.size()}});
    bytes += file;
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  }
};

}  // namespace

GlbDocument::GlbDocument(const std::vector<Eigen::Vector3f>& vertices)
    : vertices_(vertices), name_(vertices.size(), unnamed) {
  nodes_.push_back({{"name", "map"},
                    {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                    {"children", Json::array()}});
}

std::size_t GlbDocument::add_texture(const std::string& name, const std::string& png) {
  images_.push_back({{"name", name},
                     {"mimeType", "image/png"},
                     {"bufferView", of_texture_coordinates + 1 + pictures_.size()}});
  pictures_.push_back(png);
  return pictures_.size() - 1;
}

void GlbDocument::add(const std::string& name, const Triangles& triangles,
                      const GlbMaterial& material, const TextureFrame& frame, Json extras) {
  if (triangles.empty()) return;
  const Attributes geometry = add_geometry(triangles);
  Json attributes = {{"POSITION", geometry.positions}};
  if (material.texture) attributes["TEXCOORD_0"] = add_texture_coordinates(geometry.used, frame);
  meshes_.push_back({{"name", name},
                     {"primitives", Json::array({{{"attributes", attributes},
                                                  {"indices", geometry.indices},
                                                  {"material", index_of(material)}}})}});
  nodes_.front()["children"].push_back(nodes_.size());
  nodes_.push_back({{"name", name}, {"mesh", meshes_.size() - 1}, {"extras", std::move(extras)}});
}

std::string GlbDocument::written() const {
  Buffer buffer;
  buffer.add(positions_, vertex_buffer, 12);
  buffer.add(indices_, index_buffer);
  if (!texture_coordinates_.empty()) buffer.add(texture_coordinates_, vertex_buffer, 8);
  for (const std::string& picture : pictures_) buffer.add(picture);
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "planum"}}},
               {"scene", 0},
               {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
               {"nodes", nodes_},
               {"meshes", meshes_},
               {"materials", materials_},
               {"accessors", accessors_},
               {"bufferViews", buffer.views},
               {"buffers", Json::array({{{"byteLength", buffer.bytes.size()}}})}};
  if (!images_.empty()) {
    json["images"] = images_;
    json["samplers"] = Json::array({{{"magFilter", linear_filter},
                                     {"minFilter", mipmap_filter},
                                     {"wrapS", repeated},
                                     {"wrapT", repeated}}});
    for (std::size_t i = 0; i < images_.size(); ++i)
      json["textures"].push_back({{"sampler", 0}, {"source", i}});
  }
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto json_size = static_cast<std::uint32_t>(text.size());
  const auto binary_size = static_cast<std::uint32_t>(buffer.bytes.size());
  std::string file;
  append(file, {0x46546C67, 2, 12 + 8 + json_size + 8 + binary_size});
  append(file, {json_size, 0x4E4F534A});
  file += text;
  append(file, {binary_size, 0x004E4942});
  return file + buffer.bytes;
}

GlbDocument::Attributes GlbDocument::add_geometry(const Triangles& triangles) {
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
  accessors_.push_back({{"bufferView", of_positions},
                        {"byteOffset", 4 * first_position},
                        {"componentType", of_floats},
                        {"count", used.size()},
                        {"type", "VEC3"},
                        {"min", {low.x(), low.y(), low.z()}},
                        {"max", {high.x(), high.y(), high.z()}}});
  accessors_.push_back({{"bufferView", of_triangles},
                        {"byteOffset", 4 * first_index},
                        {"componentType", of_indices},
                        {"count", indices_.size() - first_index},
                        {"type", "SCALAR"}});
  return {accessors_.size() - 2, accessors_.size() - 1, std::move(used)};
}

std::size_t GlbDocument::add_texture_coordinates(const std::vector<std::uint32_t>& used,
                                                 const TextureFrame& frame) {
  accessors_.push_back({{"bufferView", of_texture_coordinates},
                        {"byteOffset", 4 * texture_coordinates_.size()},
                        {"componentType", of_floats},
                        {"count", used.size()},
                        {"type", "VEC2"}});
  for (const std::uint32_t v : used) {
    const Eigen::Vector2f place = frame.at(vertices_[v].cast<double>()).cast<float>();
    // glTF counts v from the top of a picture.
    texture_coordinates_.insert(texture_coordinates_.end(), {place.x(), 1 - place.y()});
  }
  return accessors_.size() - 1;
}

std::size_t GlbDocument::index_of(const GlbMaterial& material) {
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (materials_[i]["name"] == material.name) return i;
  materials_.push_back(material_json(material));
  return materials_.size() - 1;
}

}  // namespace planum
