#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// Points spread evenly over triangles.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;   ///< m
  std::vector<Eigen::Vector3f> normals;  ///< unit, of their triangles
};

/// One point on each `spacing` x `spacing` (m) of a mesh; the same for the same mesh.
SurfaceSamples surface_samples(const TriangleMesh& mesh, double spacing);

TriangleMesh scaled(const TriangleMesh& mesh, const Eigen::Vector3d& scale);

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh);

/// For each sample whether one of some places sees it: from outside, not too flat, and past the
/// other triangles of the mesh.
std::vector<bool> are_visible(const SurfaceSamples& samples, const TriangleMesh& mesh,
                              std::span<const Eigen::Vector3d> places);

}  // namespace planum
