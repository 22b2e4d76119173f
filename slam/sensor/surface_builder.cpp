#include "slam/sensor/surface_builder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace planum {

SurfaceBuilder::SurfaceBuilder() {
  mesh_.names = {"floor", "ceiling", "wall", "jamb", "lintel", "window", "clutter"};
}

std::uint32_t SurfaceBuilder::vertex(const Eigen::Vector3d& position) {
  const std::array<std::int64_t, 3> key{std::llround(position.x() * 1e6),
                                        std::llround(position.y() * 1e6),
                                        std::llround(position.z() * 1e6)};
  const auto [place, is_new] =
      vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.mesh.vertices.size()));
  if (is_new) mesh_.mesh.vertices.push_back(position.cast<float>());
  return place->second;
}

void SurfaceBuilder::add_triangle(const std::string& group,
                                  const std::array<Eigen::Vector3d, 3>& corners) {
  add_indexed(group, {vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
}

void SurfaceBuilder::add_indexed(const std::string& group,
                                 const std::array<std::uint32_t, 3>& triangle) {
  const auto name = std::find(mesh_.names.begin(), mesh_.names.end(), group);
  mesh_.group.push_back(static_cast<std::uint32_t>(name - mesh_.names.begin()));
  mesh_.mesh.triangles.push_back(triangle);
}

void SurfaceBuilder::add_quad(const std::string& group,
                              const std::array<Eigen::Vector3d, 4>& corners) {
  add_triangle(group, {corners[0], corners[1], corners[2]});
  add_triangle(group, {corners[0], corners[2], corners[3]});
}

void SurfaceBuilder::add_box(const std::string& group, const Eigen::Vector3d& base,
                             const Eigen::Vector3d& size, double turn) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto first = static_cast<std::uint32_t>(mesh_.mesh.vertices.size());
  // Corner i: bit 0 is +x, bit 1 is +y, bit 2 is up.
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1 ? 0.5 : -0.5) * size.x(), (i & 2 ? 0.5 : -0.5) * size.y(),
                                 i & 4 ? size.z() : 0);
    mesh_.mesh.vertices.push_back((base + rotation * corner).cast<float>());
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& [a, b, c, d] : faces) {
    add_indexed(group, {first + a, first + b, first + c});
    add_indexed(group, {first + a, first + c, first + d});
  }
}

}  // namespace planum
