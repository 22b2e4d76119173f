#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace planum {

/// An indexed triangle mesh; triangles are counter-clockwise seen from free space.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;                ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices
};

/// A triangle mesh whose triangles belong to named groups, e.g. labels ("wall") or materials.
struct LabelledMesh {
  TriangleMesh mesh;
  std::vector<std::string> names;    ///< the names of the groups
  std::vector<std::uint32_t> group;  ///< for each triangle, its index in names
};

}  // namespace planum
