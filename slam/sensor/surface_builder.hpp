#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include <Eigen/Core>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Puts a labelled mesh together from faces; corners within a micrometre become one vertex.
class SurfaceBuilder {
 public:
  SurfaceBuilder();

  /// Corners counter-clockwise seen from free space, m. The group is one of those of
  /// Building::mesh.
  void add_triangle(const std::string& group, const std::array<Eigen::Vector3d, 3>& corners);
  void add_quad(const std::string& group, const std::array<Eigen::Vector3d, 4>& corners);

  /// A closed box on the centre of its underside, turned about z (rad), seen from outside. It
  /// shares no vertex with what it touches.
  void add_box(const std::string& group, const Eigen::Vector3d& base, const Eigen::Vector3d& size,
               double turn);

  const LabelledMesh& mesh() const { return mesh_; }

 private:
  void add_indexed(const std::string& group, const std::array<std::uint32_t, 3>& triangle);
  std::uint32_t vertex(const Eigen::Vector3d& position);

  LabelledMesh mesh_;
  std::map<std::array<std::int64_t, 3>, std::uint32_t> vertices_;  ///< by position in micrometres
};

}  // namespace planum
