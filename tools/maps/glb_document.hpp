#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "slam/io/ply.hpp"
#include "tools/maps/texture_frames.hpp"

namespace planum {

/// How a surface looks; the name stands for all of it.
struct GlbMaterial {
  std::string name;
  Colour colour = {255, 255, 255};  ///< multiplied with the texture
  bool is_half_transparent = false;
  std::optional<std::size_t> texture = {};  ///< as add_texture returned it
};

/// Collects surfaces as nodes of a binary glTF 2.0 file. They are under one node, "map", that turns
/// z up into glTF's y up.
class GlbDocument {
 public:
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;

  /// `vertices` are those of the triangles to come, and must live as long as the document.
  explicit GlbDocument(const std::vector<Eigen::Vector3f>& vertices);

  std::size_t add_texture(const std::string& name, const std::string& png);

  /// Nothing is added for no triangles; `frame` is needed where the material has a texture.
  void add(const std::string& name, const Triangles& triangles, const GlbMaterial& material,
           const TextureFrame& frame, nlohmann::ordered_json extras);

  bool is_empty() const { return meshes_.empty(); }

  /// The whole file.
  std::string written() const;

 private:
  using Json = nlohmann::ordered_json;

  struct Attributes {
    std::size_t positions, indices;   ///< accessors
    std::vector<std::uint32_t> used;  ///< vertices, in the order of the accessor
  };
  Attributes add_geometry(const Triangles& triangles);
  std::size_t add_texture_coordinates(const std::vector<std::uint32_t>& used,
                                      const TextureFrame& frame);
  std::size_t index_of(const GlbMaterial& material);

  const std::vector<Eigen::Vector3f>& vertices_;
  std::vector<std::uint32_t> name_;  ///< of a vertex in the piece at hand
  std::vector<float> positions_, texture_coordinates_;
  std::vector<std::uint32_t> indices_;
  std::vector<std::string> pictures_;
  Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array(),
       accessors_ = Json::array(), images_ = Json::array();
};

}  // namespace planum
