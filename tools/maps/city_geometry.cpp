#include "tools/maps/city_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace planum {

using Json = nlohmann::ordered_json;

std::size_t CityVertices::index_of(const Eigen::Vector3d& place) {
  const Eigen::Vector3d units = (place - origin_) / scale;
  const Place rounded = {std::llround(units.x()), std::llround(units.y()), std::llround(units.z())};
  const auto [found, is_new] = index_.try_emplace(rounded, places_.size());
  if (is_new) places_.push_back(rounded);
  return found->second;
}

Json CityVertices::vertices_json() const { return places_; }

Json CityVertices::transform_json() const {
  return {{"scale", {scale, scale, scale}}, {"translate", {origin_.x(), origin_.y(), origin_.z()}}};
}

void CitySurfaces::add(std::span<const Eigen::Vector3d> vertices, const MapPolygon& shape,
                       const Json& semantics) {
  const auto indices_of = [&](const Ring& ring) {
    std::vector<std::size_t> result;
    for (const std::uint32_t v : ring) result.push_back(vertices_->index_of(vertices[v]));
    return result;
  };
  std::vector<std::vector<std::size_t>> rings = {indices_of(shape.outer)};
  for (const Ring& hole : shape.holes) rings.push_back(indices_of(hole));
  add(rings, semantics);
}

void CitySurfaces::add(const std::vector<Eigen::Vector3d>& ring, const Json& semantics) {
  std::vector<std::size_t> indices;
  for (const Eigen::Vector3d& p : ring) indices.push_back(vertices_->index_of(p));
  add(std::vector<std::vector<std::size_t>>{indices}, semantics);
}

void CitySurfaces::add(const std::vector<std::vector<std::size_t>>& rings, const Json& semantics) {
  Json surface = Json::array();
  for (std::vector<std::size_t> ring : rings) {
    // Neighbours less than the scale apart have become one.
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    if (ring.size() < 3 && surface.empty()) return;
    if (ring.size() >= 3) surface.push_back(ring);
  }
  boundaries_.push_back(std::move(surface));
  if (semantics.is_null()) {
    values_.push_back(nullptr);
  } else {
    values_.push_back(surfaces_.size());
    surfaces_.push_back(semantics);
  }
}

Json CitySurfaces::geometry_json() const {
  if (boundaries_.empty()) return Json::array();
  Json geometry = {{"type", "MultiSurface"}, {"lod", "3"}, {"boundaries", boundaries_}};
  if (!surfaces_.empty()) geometry["semantics"] = {{"surfaces", surfaces_}, {"values", values_}};
  return Json::array({geometry});
}

}  // namespace planum
