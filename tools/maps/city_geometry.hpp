#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "meshing/polygon_map.hpp"

namespace planum {

/// The vertices of a CityJSON file: integers, each place once.
class CityVertices {
 public:
  static constexpr double scale = 1e-4;  ///< m

  /// Vertices are counted from `origin` (m).
  explicit CityVertices(const Eigen::Vector3d& origin) : origin_(origin) {}

  std::size_t index_of(const Eigen::Vector3d& place);

  nlohmann::ordered_json vertices_json() const;
  nlohmann::ordered_json transform_json() const;

 private:
  using Place = std::array<std::int64_t, 3>;

  Eigen::Vector3d origin_;
  std::map<Place, std::size_t> index_;
  std::vector<Place> places_;
};

/// A MultiSurface under construction, with or without semantics.
class CitySurfaces {
 public:
  explicit CitySurfaces(CityVertices& vertices) : vertices_(&vertices) {}

  /// `semantics`: the surface's, with `type`; null where the surface is nothing in particular.
  void add(std::span<const Eigen::Vector3d> vertices, const MapPolygon& shape,
           const nlohmann::ordered_json& semantics = nullptr);

  /// A surface of one ring.
  void add(const std::vector<Eigen::Vector3d>& ring,
           const nlohmann::ordered_json& semantics = nullptr);

  /// A list of one geometry, or of none if there is no surface.
  nlohmann::ordered_json geometry_json() const;

 private:
  void add(const std::vector<std::vector<std::size_t>>& rings,
           const nlohmann::ordered_json& semantics);

  CityVertices* vertices_;
  nlohmann::ordered_json boundaries_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json surfaces_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json values_ = nlohmann::ordered_json::array();
};

}  // namespace planum
