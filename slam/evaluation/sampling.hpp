#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "slam/core/cloud.hpp"
#include "slam/core/triangle_mesh.hpp"

namespace planum {

/// `wanted` of `count` positions, ascending: one at a place that looks random in each of as many
/// even parts, so that no pattern of a scanner's rows survives. All if wanted is 0 or not below
/// count. Always the same ones.
std::vector<std::size_t> evenly_chosen(std::size_t count, std::size_t wanted);

/// A cloud of only some of the points, with their attributes.
Cloud chosen_points(const Cloud& cloud, const std::vector<std::size_t>& positions);

/// Points on a mesh and their triangles.
struct SurfaceSamples {
  std::vector<Eigen::Vector3d> points;   ///< m
  std::vector<std::uint32_t> triangles;  ///< for each point
};

/// `count` points spread over the surface by area; always the same ones. None if there is no area.
/// Throws Error if a triangle names a vertex that is not there, or a vertex is not finite.
SurfaceSamples surface_samples(const TriangleMesh& mesh, std::size_t count);

}  // namespace planum
